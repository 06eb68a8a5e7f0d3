"""Load of a run on the mounts of its bearings: stroke, the stop, and heat by element.

A mount is what tells `stroke` and `peak_stroke` beside the port that a bearing's outer ring moves with,
or, where it has several ports, in the group `mount_PORT`; a housing on springs tells its place alone.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..coupling.connections import Attachment, housing_port
from ..quantities import MOUNT_HEATS
from .final_state import ReadableSystem

SIGNS = {  # parameters of which one is not 0 where there is such an element
    "damper": ("damper.xx", "damper.yy"),
    "stop": ("stop.dissipation",),
    "film": ("film.viscosity",),
}
MOST = 4  # slides or branches
NEVER = -1.0  # s


@dataclass(frozen=True)
class MountedSeat:
    """Of one bearing."""

    name: str  # COMPONENT, or COMPONENT.mount_PORT where it has several
    stroke: float  # m, the largest distance from the relaxed place
    gap: float | None  # m, stroke up to the stop; None: there is none
    reached: float | None  # s from the scene's zero, when the stroke first reached the stop; None: never
    hits: int  # how often it did
    stop_force: float  # N, the largest
    heat: dict[str, float]  # J, by element that there is


def mounted_seat(system: ReadableSystem, a: Attachment, zero: float) -> MountedSeat | None:
    """The report of a bearing's mount at the end; None where it sits in none. zero: the scene's, s."""
    component, _, port = (housing_port(system, a.bearing) or "").rpartition(".")
    whole = next(
        (n for n in (component, f"{component}.mount_{port}") if f"{n}.peak_stroke" in system), None
    )
    if whole is None:
        return None

    def value(name: str, absent: float = 0.0) -> float:
        full = f"{whole}.{name}"
        return system.value(full) if full in system else absent

    time = value("stop_time", NEVER)
    return MountedSeat(
        whole,
        value("peak_stroke"),
        value("stop.gap") if value("stop.stiffness") > 0.0 else None,
        None if time == NEVER else time - zero,
        int(value("stop_hits")),
        value("peak_stop_force"),
        {name: value(f"heat.{name}") for name in MOUNT_HEATS if _has(whole, name, system)},
    )


def _has(mount: str, element: str, system: ReadableSystem) -> bool:
    """Whether a mount has an element that makes heat, by its parameters; cross-coupling, by what it did."""
    if element == "spring":
        signs: tuple[str, ...] = ("heat.spring",)
    elif element in ("slide", "branch"):
        signs = tuple(f"{element}[{i}].stiffness" for i in range(1, 1 + MOST))
    else:
        signs = SIGNS[element]
    names = (f"{mount}.{sign}" for sign in signs)
    return any(name in system and system.value(name) != 0.0 for name in names)


def mount_quantities(system: ReadableSystem, a: Attachment, zero: float) -> dict[str, object]:
    """Of a bearing's mount; nothing where it sits in none. Its stroke is that of a housing."""
    found = mounted_seat(system, a, zero)
    if found is None:
        return {}
    values: dict[str, object] = {"housing_stroke": found.stroke}
    if found.gap is not None:
        values["stop_reached_time"] = found.reached
        values["stop_hits"] = found.hits
        values["peak_stop_force"] = found.stop_force
    return values | {f"mount_heat_{name}": heat for name, heat in found.heat.items()}
