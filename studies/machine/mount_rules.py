"""Mounts of a machine's touchdown bearings, as text for its scene: a housing, or by rule or file.

The rules say where each number is from. None is a maker's: a ribbon, an O-ring or a film is best taken from
its measured loop (`touchdown import mount`).
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from ...bearings.supports.mount_law import Carrier
from ...master.common.errors import TouchdownError, one_of
from ...master.common.units import to_si
from ...master.scene.file import read_settings
from .machine_design import (
    GRAVITY,
    HOUSING_DAMPING,
    HOUSING_FREQUENCY,
    HOUSING_SHARE,
    MIN_HOUSING_MASS,
    STEEL_LOSS,
    Design,
    MountFile,
    rounded,
)

STIFF, SOFT = "stiff", "soft"
SLEEVE = 10.0  # soft carrier over the outer ring in it
SAG = 0.05  # of the clearance, that a rotor at rest makes a soft mount give
SLIDE_RATIO = 2.0  # stiffness of the slide over that of the spring
DRAGGED = 0.1  # of the clearance; radius of the circle that friction damps best
SPRING_DAMPING = 0.02  # ratio, of springs of metal
SHEAR_SHARE = 0.4  # stiffness along over across of a thin ring of rubber, free at its sides
SHEAR_SOURCE = "as a thin ring of rubber (Adkins and Gent 1954)"
STOP_PART = 0.5  # of the clearance
CARRIER = Carrier()  # what a file leaves open
HERTZ = 2.0 * math.pi


def chosen_mount(mount: str | None) -> str | MountFile | None:
    """The mount that `--mount` names: a rule, or a file such as `touchdown rank --mount` takes.

    Raises TouchdownError where there is no such rule, or the file cannot be used.
    """
    if mount is None or mount in (STIFF, SOFT):
        return mount
    if not mount.endswith(".toml"):
        raise TouchdownError(f"--mount {mount}: {one_of(mount, (STIFF, SOFT))}; or give a file, FILE.toml")
    path, settings = Path(mount), dict[str, object]()
    components = set[str]()
    for name, value in read_settings(path).items():
        component, dot, variable = name.partition(".")
        if not dot:
            raise TouchdownError(
                f'--mount {path}: {name} is not a setting of a component; write it under [set."housing_*"]'
            )
        components.add(component)
        settings[variable] = value
    if len(components) > 1:
        raise TouchdownError(
            f"--mount {path}: it describes {' and '.join(sorted(components))}; one mount for all is taken"
        )
    return MountFile(path.name, settings)


def model(mount: str | MountFile | None) -> str:
    """The FMU that holds the bearings: without a mount it is the housing."""
    return "housing" if mount is None else "mount"


def holding(d: Design, names: Sequence[str], mount: str | MountFile | None) -> Iterator[str]:
    """Lines of what the components `names` share, and their headings."""
    yield heading(names)
    mass = max(rounded(HOUSING_SHARE * d.landed_mass), MIN_HOUSING_MASS)
    line = f'mass = "{mass:g} kg"  # {HOUSING_SHARE:g} of what it carries, {MIN_HOUSING_MASS:g} kg at least'
    if isinstance(mount, MountFile):
        yield from () if "mass" in mount.settings else (line,)
        for name, value in mount.settings.items():
            yield f"{json.dumps(name)} = {json.dumps(value, ensure_ascii=False)}  # {mount.name}"
        if d.axial and not any(name.startswith("axial.") for name in mount.settings):
            yield _along(*_across(mount))
        return
    stiffness = rounded(mass * HOUSING_FREQUENCY**2)
    if mount == SOFT:
        yield from _soft(d, stiffness)
        return
    damping = rounded(2.0 * HOUSING_DAMPING * mass * HOUSING_FREQUENCY)
    yield line
    rule, ratio = (
        f"{HOUSING_FREQUENCY / HERTZ:.3g} Hz by itself",
        f"{HOUSING_DAMPING:g} of critical by itself",
    )
    if mount is None:
        yield f"stiffness = {stiffness_text(stiffness)}  # {rule}"
        yield f'damping = "{damping:g} N.s/m"  # {ratio}'
    else:
        yield from _tensor("spring", stiffness_text(stiffness), rule)
        yield from _tensor("damper", f'"{damping:g} N.s/m"', ratio)
        if d.axial:
            yield f'axial = {{ stiffness = {stiffness_text(stiffness)}, damping = "{damping:g} N.s/m" }}'


def _across(mount: MountFile) -> tuple[float, float]:
    """Stiffness (N/m) of a mount to quick, small motion, and its damping (N s/m), of its file."""
    defaults = {"spring.yy": CARRIER.spring.yy, "damper.yy": CARRIER.damper.yy}
    found = {
        name: to_si(value, "N.s/m" if name == "damper.yy" else "N/m", name)
        for name, value in {**defaults, **mount.settings}.items()
        if name in defaults or (name.startswith(("slide", "branch")) and name.endswith("stiffness"))
    }
    damping = found.pop("damper.yy")
    return sum(found.values()), damping


def _along(stiffness: float, damping: float) -> str:
    """A line on spring and damper along the shaft, of those across it (N/m, N s/m)."""
    spring, damper = rounded(SHEAR_SHARE * stiffness), rounded(SHEAR_SHARE * damping)
    return (
        f'axial = {{ stiffness = {stiffness_text(spring)}, damping = "{damper:g} N.s/m" }}  # '
        f"{SHEAR_SHARE:g} of what is across, {SHEAR_SOURCE}"
    )


def _tensor(name: str, value: str, rule: str) -> Iterator[str]:
    """Alike in both directions."""
    yield f"{name} = {{ xx = {value}, yy = {value} }}  # {rule}"


def _soft(d: Design, stiff: float) -> Iterator[str]:
    """A light carrier on soft springs, dry friction, and a stop as stiff as a housing, `stiff` (N/m)."""
    weight, ring = d.landed_mass * GRAVITY, max(b.outer_ring for b in d.bearings)
    mass = rounded(SLEEVE * ring)
    spring = rounded(weight / (SAG * d.clearance))
    slide = SLIDE_RATIO * spring
    force = rounded(slide * DRAGGED * d.clearance / math.sqrt(2.0))
    damping = rounded(2.0 * SPRING_DAMPING * math.sqrt(spring * (mass + ring)))
    yield f'mass = "{mass:g} kg"  # a sleeve: {SLEEVE:g} times the outer ring in it'
    yield from _tensor("spring", stiffness_text(spring), f"a rotor at rest sinks {SAG:g} of the clearance")
    yield from _tensor(
        "damper",
        f'"{damping:g} N.s/m"',
        f"{SPRING_DAMPING:g} of critical without the rotor, as metal springs",
    )
    if d.axial:
        yield _along(spring + slide, damping)
    yield f'"slide[1].stiffness" = {stiffness_text(slide)}  # {SLIDE_RATIO:g} times the spring'
    yield (
        f'"slide[1].force" = "{force:g} N"  # takes most of a circle of {DRAGGED:g} of the clearance: its '
        "stiffness times that over sqrt(2)"
    )
    gap = rounded(1e6 * STOP_PART * d.clearance)
    yield f'"stop.gap" = "{gap:g} um"  # {STOP_PART:g} of the clearance'
    yield '"stop.exponent" = 1  # a linear one'
    yield f'"stop.stiffness" = {stiff:g}  # N/m, as a housing of {HOUSING_FREQUENCY / HERTZ:.3g} Hz'
    yield f'"stop.dissipation" = {STEEL_LOSS:g}  # s/m, what a hit loses: steel on steel'


def heading(names: Sequence[str]) -> str:
    """The heading of what these components share."""
    if len(names) == 1:
        return f"[set.{names[0]}]"
    kind = names[0].partition("_")[0]
    return f'[set."{kind}_*"]'


def stiffness_text(value: float) -> str:
    """A stiffness (N/m) as text with a unit."""
    return f'"{1e-6 * value:g} MN/m"' if value >= 1e6 else f'"{1e-3 * value:g} kN/m"'
