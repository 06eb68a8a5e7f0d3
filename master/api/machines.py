"""Bearings of the catalogue, and machines of one's own."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TypedDict, Unpack

from touchdown.bearings.catalogue import Bearing
from touchdown.master.api.scenes import PathLike, load
from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.several import several
from touchdown.master.common.units import to_si
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.machine.bearings import known
from touchdown.master.studies.machine.new import CLEARANCE, UNITS, Wanted, machine, write


class MachineOptions(TypedDict, total=False):
    """What `new` may be told beside bearings and rotor: numbers in SI, or text with a unit."""

    at: str | Sequence[str]  # stations of the touchdown bearings
    amb: str | Sequence[str]  # stations of the magnetic bearings
    speed: float | str
    clearance: float | str
    mass: float | str  # of a rigid rotor, without `rotor`
    inertia: float | str


def catalogue(folder: PathLike = ".") -> dict[str, Bearing]:
    """The bearings that a scene in `folder` may take as a preset, by name: its bearings.toml's come first.

    Each has its numbers in SI (`numbers()`) and where they are from (`origins`). Raises TouchdownError
    where the file has a mistake.

    >>> bearing = touchdown.catalogue()["7014"]
    >>> bearing.balls.count, bearing.origins["balls"]
    (20, 'spaced by 1.15 diameters')
    >>> round(bearing.capacity().static)  # N, by ISO 76
    43627
    """
    return known(Path(os.fspath(folder)))


def new(
    folder: PathLike,
    bearings: str | Sequence[str],
    rotor: PathLike | None = None,
    force: bool = False,
    **options: Unpack[MachineOptions],
) -> Scene:
    """Write a machine of your own into `folder`, and return its scene.

    bearings: a touchdown bearing of the catalogue for all places, or one for each; rotor: a name, the path
    of a rotor's .toml, or a Rotor; without, a rigid one of `mass`. options: `at` and `amb`, stations of the
    rotor for touchdown and magnetic bearings (by default those not in levitated_at, and those in it),
    `speed` (rad/s; by default below its first bending frequency), `clearance` (m, radial; 0.25 mm), `mass`
    (kg), `inertia` (kg m2). What is to be known of the machine is warned of. Raises TouchdownError for what
    cannot be, and where files are there already, unless `force` replaces them.

    >>> scene = touchdown.new("my-machine", "7014", rotor="rotor_II", speed="9000 rpm")
    >>> scene.components["bearing_A"].preset
    '7014'
    """
    unknown = [key for key in options if key not in MachineOptions.__annotations__]
    if unknown:
        raise TouchdownError(
            f"new has no option {unknown[0]}; {one_of(unknown[0], MachineOptions.__annotations__)}"
        )
    given = {key: to_si(options[key], unit, key) for key, unit in UNITS.items() if key in options}
    wanted = Wanted(
        bearings=(bearings,) if isinstance(bearings, str) else tuple(bearings),
        rotor=None if rotor is None else os.fspath(rotor),
        at=_stations(options.get("at")),
        amb=_stations(options.get("amb")),
        **{"clearance": CLEARANCE, **given},
    )
    path = Path(os.fspath(folder))
    made = machine(wanted, path.absolute().name)
    for note in made.notes:
        warnings.warn(note, stacklevel=2)
    return load(write(made, path, force))


def _stations(names: str | Sequence[str] | None) -> list[str] | None:
    """One or more, also as one text with commas between them."""
    if names is None:
        return None
    return [one.strip() for name in several(names) for one in name.split(",")]
