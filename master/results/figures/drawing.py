"""Pictures of a run: which of them there are, and their files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from touchdown.master.common.files import replacing
from touchdown.master.coupling.connections import Attachment
from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.contacts import contacts, has_contacts
from touchdown.master.results.figures.energy import energy
from touchdown.master.results.figures.forces import forces
from touchdown.master.results.figures.motion import distance, paths, slowing, speeds
from touchdown.master.results.figures.orbits import orbits
from touchdown.master.results.figures.spectrum import has_spectrum, spectrum
from touchdown.master.results.figures.stress import has_stress, stress
from touchdown.master.results.figures.style import darkened, sheet, styled
from touchdown.master.results.figures.waterfall import has_waterfall, motion_waterfall
from touchdown.master.results.recording import NotRecordedError
from touchdown.master.results.stresses import stressed
from touchdown.master.results.summary import energy_total, is_heard, touchdown_seats

Picture = tuple[str, Callable[[Figure], object]]  # name of the file, and what draws it on an empty figure


DPI = 110


@dataclass(frozen=True)
class OfBearing:
    """A picture of one touchdown bearing."""

    name: str  # of its file
    draw: Callable[[Figure, Finished, Attachment], object]
    there: Callable[[Finished, Attachment], bool] = lambda run, a: True
    """Whether the run has what it shows."""


OF_BEARING = [
    OfBearing("orbit", paths),
    OfBearing("force", forces, lambda run, a: f"{a.bearing}.contact.force" in run.recording),
    OfBearing("speeds", speeds, lambda run, a: f"{a.bearing}.speed.ring" in run.recording),
    OfBearing("distance", distance, lambda run, a: is_heard(run.system, a)),
    OfBearing("slowing", slowing, lambda run, a: is_heard(run.system, a)),
    OfBearing("contacts", contacts, lambda run, a: has_contacts(run.system, a)),
    OfBearing("spectrum", spectrum, lambda run, a: has_spectrum(run.recording, a)),
    OfBearing("waterfall", motion_waterfall, lambda run, a: has_waterfall(run.recording, a)),
]

NAMES = (*(picture.name for picture in OF_BEARING), "orbits", "stress", "energy")
"""Of all files, before the component that some have at the end."""


def draw_all(run: Finished, folder: Path, dark: bool = False) -> list[Path]:
    """Draw what the scene is about, as far as it was recorded, into `folder`; returns the files.

    dark: on a dark ground.
    """
    made: list[Path] = []
    for name, draw in _pictures(run):
        with suppress(NotRecordedError), styled():
            figure = sheet()
            draw(figure)
            if dark:
                darkened(figure)
            path = folder / f"{name}.png"
            with replacing(path) as part:
                figure.savefig(part, dpi=DPI, format="png")
            made.append(path)
    return made


def _pictures(run: Finished) -> Iterator[Picture]:
    seats = touchdown_seats(run.system)
    for a in seats:
        tail = f"-{a.bearing}" if len(seats) > 1 else ""
        for picture in OF_BEARING:
            if picture.there(run, a):
                yield f"{picture.name}{tail}", _of_bearing(picture, run, a)
    if len(seats) > 1:
        yield "orbits", partial(orbits, run=run, seats=seats)
    rotors = stressed(run.system)
    for name in rotors:
        tail = f"-{name}" if len(rotors) > 1 else ""
        if has_stress(run.system, name):
            yield f"stress{tail}", partial(stress, run=run, name=name)
    if energy_total(run.system, run.recording) is not None:
        yield "energy", partial(energy, run=run)


def _of_bearing(picture: OfBearing, run: Finished, a: Attachment) -> Callable[[Figure], object]:
    return lambda figure: picture.draw(figure, run, a)
