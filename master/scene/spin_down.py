"""What a scene sets where it runs from the drop to the standstill: minutes of rolling, little is new.

Steps and rows are longer, the bearings' own steps coarser, and bending modes fewer, but for what the user
set beside the scene. In steady whirl the tolerance changes the mean contact force by 0.1 %; with 1e-4, ten
times as much, and steps of 50 us, a whirl may end that goes on.
"""

from __future__ import annotations

from ...modelkit.errors import require
from ..common.units import to_si
from .run_spec import STANDSTILL
from .scene import ComponentSpec, Scene, is_file

MACRO_STEP = 5e-5  # s
ROW_STEP = 5e-4  # s, from one recorded row to the next
TOLERANCE = 1e-5  # of a bearing's steps, over its scales
MODES = 6  # per plane, of a flexible rotor


def spin_down(scene: Scene, duration: float | str) -> Scene:
    """A copy of `scene` that runs until its rotors stand still, for `duration` (s) at most.

    A controller keeps its macro step. What the user set beside the scene stays. Raises TouchdownError where
    that is a duration.
    """
    run = scene.run
    require(
        "duration" not in scene.own or run.until == STANDSTILL,  # of one that goes on
        f"--spin-down {duration} is the longest duration, beside which run.duration = {run.duration:g} s "
        "would be another; leave out one of them",
    )
    kept = scene.control or "macro_step" in scene.own
    step = run.macro_step if kept else max(run.macro_step, MACRO_STEP)
    wanted: dict[str, object] = {
        "run.until": STANDSTILL,
        "run.macro_step": step,
        "run.record_every": max(run.record_every, round(ROW_STEP / step)),
    }
    wanted = {name: value for name, value in wanted.items() if name.removeprefix("run.") not in scene.own}
    for name, spec in scene.components.items():
        wanted |= {f"{name}.{key}": value for key, value in _coarser(spec) if key not in spec.own}
    return scene.set({**wanted, "run.duration": to_si(duration, "s", "spin_down")})


def _coarser(spec: ComponentSpec) -> list[tuple[str, float]]:
    """Settings of a component that make it cheaper."""
    modes = float(str(spec.set.get("modes", MODES)))
    found = [("modes", float(MODES))] if modes > MODES or modes == 0.0 else []
    if not is_file(spec.fmu) and _keeps_tolerance(spec.fmu):
        found.append(("interface.tolerance", TOLERANCE))
    return found


def _keeps_tolerance(name: str) -> bool:
    """Whether the steps of a bearing keep to a tolerance, and are not of one length."""
    from ...fmus.recipes import recipe  # numba, which a list of scenes can do without
    from ...modelkit.variables import flatten

    names = {variable.name for variable in flatten(recipe(name).model.parameters())}
    return "interface.tolerance" in names and "micro_step" not in names
