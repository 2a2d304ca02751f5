from .charts import gap_flow_figure as gap_flow_figure
from .charts import trapped_water_figure as trapped_water_figure
from .gap_flow import GapFlow as GapFlow
from .gap_flow import Junction as Junction
from .gap_flow import gap_flow as gap_flow
