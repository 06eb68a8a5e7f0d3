"""The time a rotor floats before its magnetic bearings shut down, made short where it is not looked at."""

from __future__ import annotations

from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.scene import Scene

SHORT = 2e-3  # s


def shortened(scene: Scene) -> Scene:
    """A copy whose magnetic bearings shut down earlier, all by as much, the first SHORT after the start.

    One that shuts down as early already stays as it is. An unbalanced rotor then falls from another
    angle: it is another drop of the same machine.
    """
    with opened(scene, in_process=True) as system:
        times = {
            name: system.value(f"{name}.shutdown_time")
            for name, component in system.components.items()
            if "shutdown_time" in component.variables
        }
    early = min(times.values(), default=0.0) - scene.run.start_time - SHORT
    if early <= 0.0:
        return scene
    return scene.set({f"{name}.shutdown_time": time - early for name, time in times.items()})
