"""Pictures of a run: which of them there are, and their files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
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


def draw_all(scene: Scene, system: System, recording: Recording, folder: Path) -> list[Path]:
    """Draw what the scene is about, as far as it was recorded, into `folder`; returns the files."""
    made: list[Path] = []
    for name, draw in _pictures(scene, system, recording):
        with suppress(NotRecordedError):
            made.append(_save(draw(), folder / f"{name}.png"))
    return made


Picture = tuple[str, Callable[[], Figure]]  # name of the file, and how it is drawn


def _pictures(scene: Scene, system: System, recording: Recording) -> Iterator[Picture]:
    seats = touchdown_seats(system)
    for a in seats:
        tail = f"-{a.bearing}" if len(seats) > 1 else ""
        for name, draw in _of_bearing(scene, system, recording, a):
            yield f"{name}{tail}", draw
    if len(seats) > 1:
        yield "orbits", partial(orbits, scene, system, recording, seats)
    rotors = stressed(system)
    for name in rotors:
        tail = f"-{name}" if len(rotors) > 1 else ""
        if has_stress(system, name):
            yield f"stress{tail}", partial(stress, scene, system, recording, name)
    if energy_total(system, recording) is not None:
        yield "energy", partial(energy, scene, system, recording)


def _of_bearing(scene: Scene, system: System, recording: Recording, a: Attachment) -> Iterator[Picture]:
    """Of one touchdown bearing."""
    yield "orbit", partial(orbit, scene, system, recording, a)
    if f"{a.bearing}.contact.force" in recording:
        yield "force", partial(forces, scene, system, recording, a)
    if f"{a.bearing}.speed.ring" in recording:
        yield "speeds", partial(speeds, scene, system, recording, a)
    if has_contacts(system, a):
        yield "contacts", partial(contacts, scene, system, recording, a)
    if has_spectrum(recording, a):
        yield "spectrum", partial(spectrum, scene, recording, a)
    if has_waterfall(recording, a):
        yield "waterfall", partial(motion_waterfall, scene, recording, a)


def _save(figure: Figure, path: Path) -> Path:
    figure.savefig(path, dpi=110)
    return path
