from .conditions import Conditions as Conditions
