"""Pictures of a run: which there are, their files, and how they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from ...master.common.errors import TouchdownError, one_of
from ...master.coupling.connections import Attachment
from ...master.results.final_state import Finished
from ...master.results.recording import NotRecordedError
from ...master.results.spectra import WINDOW_S, WINDOW_START_S
from ...master.results.stresses import stressed
from ...master.results.summary import energy_total, holding_seats, is_estimated, touchdown_seats
from ...modelkit.kernel.writing import child_path
from .energy import energy
from .forces import contacts, draw_contacts, forces, has_contacts
from .motion import along, distance, draw_orbit, gaps_left, has_faces, held, orbits, paths, slowing, speeds
from .spectra import MIN_TIME_S, has_spectrum, has_waterfall, motion_waterfall, spectrum
from .stress import has_stress, stress
from .style import darkened, drawable, save, sheet, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase


Picture = tuple[str, Callable[[Figure], object]]  # name of the file, and what draws it on an empty figure


DPI = 110


@dataclass(frozen=True)
class OfBearing:
    """A picture of one touchdown bearing."""

    name: str  # of its file, one of PICTURES in master/results/folder.py
    draw: Callable[[Figure, Finished, Attachment], object]
    there: Callable[[Finished, Attachment], bool] = lambda run, a: True
    """Whether the run has what it shows."""


OF_BEARING = [
    OfBearing("orbit", paths),
    OfBearing("along", along, has_faces),
    OfBearing("force", forces, lambda run, a: f"{a.bearing}.contact.force" in run.recording),
    OfBearing("speeds", speeds, lambda run, a: f"{a.bearing}.speed.ring" in run.recording),
    OfBearing("distance", distance, lambda run, a: is_estimated(run.system, a)),
    OfBearing("slowing", slowing, lambda run, a: is_estimated(run.system, a)),
    OfBearing("contacts", contacts, lambda run, a: has_contacts(run.system, a)),
    OfBearing("spectrum", spectrum, lambda run, a: has_spectrum(run.recording, a)),
    OfBearing("waterfall", motion_waterfall, lambda run, a: has_waterfall(run.recording, a)),
]


def draw_all(run: Finished, folder: Path, dark: bool = False) -> list[Path]:
    """Draw what the scene is about, as far as it was recorded, into `folder`; returns the files.

    dark: on a dark ground.
    """
    paths: list[Path] = []
    for name, draw in _pictures(run):
        with suppress(NotRecordedError), styled():
            figure = sheet()
            draw(figure)
            if dark:
                darkened(figure)
            paths.append(save(figure, child_path(folder, f"{name}.png"), DPI))
    return paths


def _pictures(run: Finished) -> Iterator[Picture]:
    seats = touchdown_seats(run.system)
    for a in seats:
        tail = f"-{a.bearing}" if len(seats) > 1 else ""
        for picture in OF_BEARING:
            if picture.there(run, a):
                yield f"{picture.name}{tail}", _of_bearing(picture, run, a)
    holding = holding_seats(run.system)
    for a in holding:
        yield f"held-{a.bearing}" if len(holding) > 1 else "held", partial(held, run=run, a=a)
    if len(seats) > 1:
        yield "orbits", partial(orbits, run=run, seats=seats)
    if run.scene.gaps:
        yield "gaps", partial(gaps_left, run=run)
    rotors = stressed(run.system)
    for name in rotors:
        tail = f"-{name}" if len(rotors) > 1 else ""
        if has_stress(run.system, name):
            yield f"stress{tail}", partial(stress, run=run, name=name)
    if energy_total(run.system, run.recording) is not None:
        yield "energy", partial(energy, run=run)


def _of_bearing(picture: OfBearing, run: Finished, a: Attachment) -> Callable[[Figure], object]:
    return lambda figure: picture.draw(figure, run, a)


class Plot:
    """The pictures of a run.

    Those of one panel take the axes to draw on and return them; those of several take a figure, or a part
    of one, and return all their axes. Without, they make a figure of their own with pyplot, so that a
    notebook shows it. Those of a bearing are of the scene's first, unless one is named. All raise
    TouchdownError where the run has not what they show.
    """

    def __init__(self, run: Callable[[], Finished], dark: bool = False) -> None:
        self._run, self._dark = run, dark

    def __repr__(self) -> str:
        names = [name for name in vars(type(self)) if not name.startswith("_")]
        return f"<pictures of a run: {', '.join(names)}>"

    @property
    def dark(self) -> Plot:
        """The same pictures on a dark ground: `result.plot.dark.orbit()`."""
        return Plot(self._run, dark=True)

    def orbit(self, ax: Axes | None = None, bearing: str | None = None) -> Axes:
        """The rotor in the clearance circle of a bearing [µm]."""
        with self._on(ax) as axes:
            return draw_orbit(axes, self._run(), self._seat(bearing))

    def paths(self, figure: FigureBase | None = None, bearing: str | None = None) -> list[Axes]:
        """The rotor in the clearance circle, its landing from near, and where rings and cage go [µm]."""
        with self._drawing(figure) as whole:
            return paths(whole, self._run(), self._seat(bearing))

    def orbits(self, figure: FigureBase | None = None) -> list[Axes]:
        """The rotor in all its bearings side by side [µm]."""
        self._seat(None)
        with self._drawing(figure) as whole:
            return orbits(whole, self._run(), touchdown_seats(self._run().system))

    def forces(self, figure: FigureBase | None = None, bearing: str | None = None) -> list[Axes]:
        """Contact forces in a bearing over time [N]: of the rotor, and of the ball hit hardest."""
        seat = self._seat(bearing)
        self._require(f"{seat.bearing}.contact.force")
        with self._drawing(figure) as whole:
            return forces(whole, self._run(), seat)

    def along(self, figure: FigureBase | None = None, bearing: str | None = None) -> list[Axes]:
        """Rotor and ring along the shaft between the faces [µm], and the forces there [N]."""
        run, seat = self._run(), self._seat(bearing)
        if not has_faces(run, seat):
            raise TouchdownError(
                f"{seat.bearing} has no faces for a shoulder to land on; set its shoulder.gap_minus or "
                "shoulder.gap_plus, and axial = 1 of the rotor"
            )
        with self._drawing(figure) as whole:
            return along(whole, run, seat)

    def speeds(self, figure: FigureBase | None = None, bearing: str | None = None) -> list[Axes]:
        """Circumferential speeds of rotor, ring, balls and cage over time [m/s]."""
        seat = self._seat(bearing)
        self._require(f"{seat.bearing}.speed.ring")
        with self._drawing(figure) as whole:
            return speeds(whole, self._run(), seat)

    def contacts(self, ax: Axes | None = None, bearing: str | None = None) -> Axes:
        """The balls of a detailed bearing at the end of the run, and which of them are pressed."""
        run, seat = self._run(), self._seat(bearing)
        if not has_contacts(run.system, seat):
            raise TouchdownError(f"{seat.bearing} does not report single balls; swap in a detailed bearing")
        with self._on(ax) as axes:
            return draw_contacts(axes, run, seat)

    def energy(self, figure: FigureBase | None = None) -> list[Axes]:
        """Where the energy is, and its balance [J]."""
        run = self._run()
        if energy_total(run.system, run.recording) is None:
            raise TouchdownError("not all components state and record their energies; see run.record")
        with self._drawing(figure) as whole:
            return energy(whole, run)

    def spectrum(self, figure: FigureBase | None = None, bearing: str | None = None) -> list[Axes]:
        """Amplitude of the inner ring's velocity over frequency, after the landing [m/s, Hz]."""
        run, seat = self._run(), self._seat(bearing)
        self._require(f"{seat.bearing}.ring.x")
        if not has_spectrum(run.recording, seat):
            raise TouchdownError(
                f"a spectrum needs a run.duration of {WINDOW_START_S + WINDOW_S:.3g} s or more"
            )
        with self._drawing(figure) as whole:
            return spectrum(whole, run, seat)

    def waterfall(self, figure: FigureBase | None = None, bearing: str | None = None) -> list[Axes]:
        """How the rotor moves in a bearing over time and frequency, with the spin and against it [µm]."""
        run, seat = self._run(), self._seat(bearing)
        if not has_waterfall(run.recording, seat):
            raise TouchdownError(
                f"a waterfall needs a run.duration of {MIN_TIME_S:g} s or more, and the motion of "
                f"{seat.body_end.title}; see run.record_every and run.record"
            )
        with self._drawing(figure) as whole:
            return motion_waterfall(whole, run, seat)

    def stress(self, figure: FigureBase | None = None, rotor: str | None = None) -> list[Axes]:
        """Stresses of a flexible rotor [MPa] along its axis and over time; of the scene's first."""
        run = self._run()
        known = [name for name in stressed(run.system) if has_stress(run.system, name)]
        if not known:
            raise TouchdownError(
                f"no rotor of scene {run.scene.name} has a stress to show; rotor.stress.active = 1 asks a "
                "flexible one for it"
            )
        if rotor is not None and rotor not in known:
            raise TouchdownError(f"{rotor} has no stress to show; {one_of(rotor, known)}")
        with self._drawing(figure) as whole:
            return stress(whole, run, rotor or known[0])

    def _seat(self, bearing: str | None) -> Attachment:
        """Of the bearing of that name, or of the first."""
        run = self._run()
        seats = {a.bearing: a for a in touchdown_seats(run.system)}
        if not seats:
            raise TouchdownError(f"scene {run.scene.name} has no touchdown bearing to show")
        if bearing is not None and bearing not in seats:
            raise TouchdownError(f"there is no touchdown bearing {bearing}; {one_of(bearing, seats)}")
        return seats[bearing] if bearing else next(iter(seats.values()))

    def _require(self, name: str) -> None:
        """Raise NotRecordedError where COMPONENT.VARIABLE was not recorded."""
        self._run().recording[name]

    @contextmanager
    def _drawing(self, figure: FigureBase | None) -> Iterator[FigureBase]:
        """`figure`, or a new one, to draw on in the project's style."""
        with styled():
            whole = drawable(figure)
            yield whole
        if self._dark:
            darkened(whole)

    @contextmanager
    def _on(self, ax: Axes | None) -> Iterator[Axes]:
        """`ax`, or those of a new figure."""
        with self._drawing(None if ax is None else ax.figure) as whole:
            yield whole.subplots() if ax is None else ax
