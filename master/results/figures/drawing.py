"""Pictures of a run: which of them there are, and their files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from matplotlib.figure import Figure

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.system import System
from touchdown.master.results.figures.contacts import contacts, has_contacts
from touchdown.master.results.figures.energy import energy
from touchdown.master.results.figures.forces import forces
from touchdown.master.results.figures.motion import orbit, speeds
from touchdown.master.results.figures.orbits import orbits
from touchdown.master.results.figures.spectrum import has_spectrum, spectrum
from touchdown.master.results.figures.stress import has_stress, stress
from touchdown.master.results.figures.waterfall import has_waterfall, motion_waterfall
from touchdown.master.results.recording import NotRecordedError, Recording
from touchdown.master.results.stresses import stressed
from touchdown.master.results.summary import energy_total, touchdown_seats
from touchdown.master.scene.scene import Scene

Picture = tuple[str, Callable[[], Figure]]  # name of the file, and how it is drawn


@dataclass(frozen=True)
class OfBearing:
    """A picture of one touchdown bearing."""

    name: str  # of its file
    draw: Callable[[Scene, System, Recording, Attachment], Figure]
    there: Callable[[System, Recording, Attachment], bool] = lambda system, recording, a: True
    """Whether the run has what it shows."""


OF_BEARING = [
    OfBearing("orbit", orbit),
    OfBearing("force", forces, lambda _, recording, a: f"{a.bearing}.contact.force" in recording),
    OfBearing("speeds", speeds, lambda _, recording, a: f"{a.bearing}.speed.ring" in recording),
    OfBearing("contacts", contacts, lambda system, _, a: has_contacts(system, a)),
    OfBearing(
        "spectrum",
        lambda scene, _, recording, a: spectrum(scene, recording, a),
        lambda _, recording, a: has_spectrum(recording, a),
    ),
    OfBearing(
        "waterfall",
        lambda scene, _, recording, a: motion_waterfall(scene, recording, a),
        lambda _, recording, a: has_waterfall(recording, a),
    ),
]


def draw_all(scene: Scene, system: System, recording: Recording, folder: Path) -> list[Path]:
    """Draw what the scene is about, as far as it was recorded, into `folder`; returns the files."""
    made: list[Path] = []
    for name, draw in _pictures(scene, system, recording):
        with suppress(NotRecordedError):
            made.append(_save(draw(), folder / f"{name}.png"))
    return made


def _pictures(scene: Scene, system: System, recording: Recording) -> Iterator[Picture]:
    seats = touchdown_seats(system)
    for a in seats:
        tail = f"-{a.bearing}" if len(seats) > 1 else ""
        for picture in OF_BEARING:
            if picture.there(system, recording, a):
                yield f"{picture.name}{tail}", partial(picture.draw, scene, system, recording, a)
    if len(seats) > 1:
        yield "orbits", partial(orbits, scene, system, recording, seats)
    rotors = stressed(system)
    for name in rotors:
        tail = f"-{name}" if len(rotors) > 1 else ""
        if has_stress(system, name):
            yield f"stress{tail}", partial(stress, scene, system, recording, name)
    if energy_total(system, recording) is not None:
        yield "energy", partial(energy, scene, system, recording)


def _save(figure: Figure, path: Path) -> Path:
    figure.savefig(path, dpi=110)
    return path
