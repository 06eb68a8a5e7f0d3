"""Results of a run for Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...master.results import result as results
from ...master.results.final_state import Finished

if TYPE_CHECKING:
    from ...reports.figures.plot import Plot


class Result(results.Result):
    """Results of a run.

    `summary` holds its quantities in SI, nested by seat, component and gap; None where something did not
    happen. `flat` is the same with one path for each value. `touchdown scenes --quantities` lists them.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> result.ended
    <Ended.COMPLETED: 'completed'>
    >>> round(result.summary["seats"]["A"]["first_contact_speed"], 3)  # m/s
    0.077
    >>> result.data["rotor.A.y"].attrs["units"]
    'm'
    >>> float(result.data["rotor.A.y"].min()) < -200e-6
    True
    >>> list(result.to_pandas(["rotor.A.x", "rotor.A.y"]))
    ['rotor.A.x', 'rotor.A.y']
    >>> result.plot.orbit().get_xlabel()
    'x in space [µm]'
    """

    @property
    def plot(self) -> Plot:
        """Pictures: `plot.orbit()`, `plot.forces()` and more, each of which returns its axes."""
        from ...reports.figures.plot import Plot

        return Plot(lambda: Finished(self.scene, self.ending, self.recording))
