"""How studies run scenes where nothing is to end a run before its time."""

from __future__ import annotations

from ...master.scene.scene import Scene

NO_STOP_RESIDUAL = 1e300  # of the ledger, which no run reaches
UNDIVIDED = {"run.whirl_halvings": 0, "run.impact_step": 0}  # every macro step as long as the scene says


def unstopped(scene: Scene) -> Scene:
    """A copy that the ledger does not stop; it warns as before."""
    return scene.set({"run.stop_residual": NO_STOP_RESIDUAL})


def undivided(scene: Scene) -> Scene:
    """A copy that the ledger does not stop, and that takes all of its macro steps whole."""
    return unstopped(scene).set(UNDIVIDED)
