from .examples import EXAMPLES as EXAMPLES
from .examples import Example as Example
from .examples import write_example as write_example
