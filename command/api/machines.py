"""Bearings of the catalogue, machines of one's own, reports on runs and films of them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TypedDict, Unpack

from ...bearings.catalogue import Bearing
from ...master.common.errors import TouchdownError, as_list, one_of
from ...master.common.progress import bar_over
from ...master.common.units import to_si
from ...master.scene.scene import Scene
from ...studies.machine.bearings import available_bearings
from ...studies.machine.new import CLEARANCE, UNITS, Wanted, machine, write
from ...studies.sweep.definition import DEFINITION_FILE as SWEEP
from ...studies.sweep.results import Sweep
from ...studies.sweep.results import read as read_sweep
from .run import PathLike, Result, load, open_result


class MachineOptions(TypedDict, total=False):
    """Options of `new` beside bearings and rotor: numbers in SI, or text with a unit."""

    at: str | Sequence[str]  # stations of the touchdown bearings
    amb: str | Sequence[str]  # stations of the magnetic bearings
    speed: float | str
    clearance: float | str
    mass: float | str  # of a rigid rotor, without `rotor`
    inertia: float | str
    balls: str  # material of the bearings' balls
    mount: PathLike  # soft, stiff, or the path of a mount's .toml


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
    return available_bearings(Path(os.fspath(folder)))


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
    (kg), `inertia` (kg m2), `balls` ("steel" or "Si3N4"), `mount` ("soft", "stiff" or a mount's .toml; by
    default a linear housing). What is to be known of the machine is warned of.
    Raises TouchdownError for what cannot be, and where files are there already, unless `force` replaces
    them.

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
        balls=options.get("balls", "steel"),
        mount=None if (mount := options.get("mount")) is None else os.fspath(mount),
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
    return [one.strip() for name in as_list(names) for one in name.split(",")]


def report(
    run: Result | Sweep | PathLike, path: PathLike | None = None, *, pdf: bool = False
) -> list[Path]:
    """Write the report of a run or a sweep, given itself or its folder, as one page; returns the files.

    `path`: of the page; None: report.html in the run's folder. pdf: print it, too, beside the page, by a
    Chromium on the PATH. The page needs nothing beside it. Raises TouchdownError where there is no such
    run, or it cannot be written or printed.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> [path.name for path in touchdown.report(result, "drop.html")]
    ['drop.html']
    """
    # matplotlib, which these import, is slow to come
    from ...reports.page import PAGE, browser, make_room, print_page, report_on, write_page
    from ...reports.sweeps import report_on_sweep

    if pdf:
        browser()  # first of all: a page takes seconds
    found = run if isinstance(run, (Result, Sweep)) else _read(Path(run))
    page = Path(path) if path else found.folder / PAGE
    make_room(page)
    write_page(report_on_sweep(found) if isinstance(found, Sweep) else report_on(found), page)
    return [page, print_page(page, page.with_suffix(".pdf"))] if pdf else [page]


def _read(folder: Path) -> Result | Sweep:
    """The run or the sweep in a folder. Raises TouchdownError where there is neither."""
    return read_sweep(folder) if os.path.isfile(folder / SWEEP) else open_result(folder)


def animate(run: Result | PathLike, path: PathLike | None = None, *, progress: bool = False) -> Path:
    """Draw the drop of a run, given its result or its folder, as a film, .gif or .mp4; returns its path.

    Rotor, ring, balls and cage turn, an arrow is the force on the journal, and the first impact goes
    slowly. `path`: None: drop.gif in the run's folder; progress: show a bar. An .mp4 takes ffmpeg, from the
    PATH or the extra `animate`. Raises TouchdownError where nothing touched, or the film cannot be made.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> touchdown.animate(touchdown.run(scene, in_process=True), "drop.gif").name
    'drop.gif'
    """
    from ...reports.animation import checked_suffix, film_frames, motions, write_film
    from ...reports.blocks import Absent
    from ...reports.subject import Subject

    result = run if isinstance(run, Result) else open_result(run)
    film = Path(path) if path else result.folder / "drop.gif"
    checked_suffix(film)
    try:
        shown, lacking = motions(Subject(result))
    except Absent as absent:
        shown, lacking = [], [str(absent)]
    if not shown:
        raise TouchdownError(f"there is no drop to show: {' '.join(lacking) or 'no touchdown bearing'}")
    frames = len(film_frames(shown, film.suffix.lower()))
    with bar_over(frames, "frames", not progress) as bar:
        return write_film(shown, result.scene.title, film, bar.update)
