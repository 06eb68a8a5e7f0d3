"""Recording to HDF5, streamed: memory stays flat, and the file is whole at every moment.

The file is netCDF-4 as well: any reader of either opens it, also while the run goes on, and after it was
killed. One group per component holds one dataset per variable, with the attributes `units` and `long_name`;
`time`, in seconds from the scene's zero, is the one dimension of all of them. What is not recorded over
time is kept of the end, as attributes of the group `at_end/COMPONENT`. The attributes of the root say what
was run: title, scene, version, scheme, macro_step_s.
"""

from touchdown.master.coupling.recorder.recorder import Recorder
from touchdown.master.coupling.recorder.table import END, TIME

__all__ = ["END", "TIME", "Recorder"]
