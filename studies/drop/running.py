"""How studies run scenes: where nothing ends a run before its time, and how long it takes."""

from __future__ import annotations

import tempfile
from pathlib import Path

from ...master.coupling.loop.span import brief
from ...master.coupling.simulation import Outcome, opened, simulate
from ...master.scene.scene import Scene

NO_STOP_RESIDUAL = 1e300  # of the ledger, which no run reaches
UNDIVIDED = {"run.whirl_halvings": 0, "run.impact_step": 0}  # every macro step as long as the scene says


def unstopped(scene: Scene) -> Scene:
    """A copy that the ledger does not stop; it warns as before."""
    return scene.set({"run.stop_residual": NO_STOP_RESIDUAL})


def undivided(scene: Scene) -> Scene:
    """A copy that the ledger does not stop, and that takes all of its macro steps whole."""
    return unstopped(scene).set(UNDIVIDED)


def warm_up(scene: Scene, in_process: bool, recorded: bool = False) -> None:
    """Take two macro steps, which compile what is to be timed; a run that stops there is not refused."""
    _simulated(scene, in_process, recorded, steps=2).raise_if_interrupted()


def wall_time(scene: Scene, in_process: bool, recorded: bool = False) -> float:
    """Wall time of a run (s per simulated s). Raises TouchdownError where it stops by itself."""
    outcome = _simulated(scene, in_process, recorded)
    outcome.raise_if_stopped()
    return outcome.wall_time / outcome.simulated


def _simulated(scene: Scene, in_process: bool, recorded: bool, steps: int | None = None) -> Outcome:
    with tempfile.TemporaryDirectory() as folder, opened(scene, in_process) as system:
        run = scene if steps is None else brief(scene, system, steps)
        return simulate(run, system, Path(folder) / "result.h5" if recorded else None)
