"""Bearings of the catalogue, new machines; reports on runs, films and tables of them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ...master.common.errors import TouchdownError
from ...master.common.progress import bar_over
from ..parameters import (
    Angle,
    Count,
    Fraction,
    Inertia,
    Length,
    Mass,
    Names,
    PathLike,
    Places,
    Speed,
    Spin,
    Texts,
    bare_speeds,
    parted,
)
from .run import load, open_result

if TYPE_CHECKING:
    from ...bearings.catalogue import Bearing
    from ...master.scene.scene import Scene
    from ...studies.drop.differences import Differences
    from ...studies.machine.foundation_file import ImportedFoundation
    from ...studies.machine.mount_file import ImportedMount
    from ...studies.sweep.results import Sweep
    from .result import Result
    from .rotor import Rotor


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
    from ...studies.machine.bearings import available_bearings

    return available_bearings(Path(os.fspath(folder)))


def new(
    folder: PathLike,
    bearings: Names,
    rotor: PathLike | None = None,
    force: bool = False,
    *,
    at: Names | None = None,
    amb: Names | None = None,
    speed: Speed | None = None,
    clearance: Length = "0.25 mm",
    balls: str | None = None,
    mount: PathLike | None = None,
    mass: Mass | None = None,
    inertia: Inertia | None = None,
    axial: str | None = None,
    inclination: Angle = 0.0,
    controller: bool = False,
) -> Scene:
    """Create a folder with a first scene for your machine.

    folder: where the scene is written, with all files it needs
    bearings: touchdown bearings: one for all, or one for each place, in order or as STATION=NAME;
        `touchdown catalogue` lists them
    rotor: name of a rotor, or path of its .toml; in Python also a Rotor
    force: replace files that are there
    at: stations of the rotor's file, by name, at which touchdown bearings hold it (default: those that are
        not in levitated_at); a station is made by `touchdown import rotor`, as NAME=PLACE
    amb: the same of the magnetic bearings (default: its levitated_at)
    speed: at the start (default: the lower of 0.7 of the first bending frequency and 1,000,000 mm rpm over
        the bore)
    clearance: radial
    balls: material of the balls: steel, or Si3N4 in hybrid bearings (default: what the designation says,
        where HC is ceramic)
    mount: mounts of the touchdown bearings: soft or stiff by rules, or from a TOML file such as
        `touchdown import mount` writes (default: a linear housing)
    mass: of a rigid rotor, in place of a named one
    inertia: its polar moment of inertia (default: mass times journal radius^2)
    axial: station of the touchdown bearing on whose faces a shoulder of the rotor lands (default: that of
        the first pair with a contact angle; without one the rotor keeps its place along the shaft)
    inclination: of the shaft's +z end over the horizontal, 90 deg for an upright machine (default: it lies)
    controller: size magnets and amplifiers of the magnetic bearings, and tune their controller

    Returns the scene. What is to be known of the machine is warned of. Raises TouchdownError for what
    cannot be, and where files are there already.

    >>> scene = touchdown.new("my-machine", "7014", rotor="rotor_II", speed="9000 rpm")
    >>> scene.components["bearing_A"].preset
    '7014'
    """
    from ...master.common.units import to_si
    from ...studies.machine.new import UNITS, Wanted, machine, write

    quantities = {"speed": speed, "clearance": clearance, "mass": mass, "inertia": inertia}
    numbers = {k: to_si(value, UNITS[k], k) for k, value in quantities.items() if value is not None}
    request = Wanted(
        bearings=parted(bearings),
        rotor=None if rotor is None else os.fspath(rotor),
        at=None if at is None else parted(at),
        amb=None if amb is None else parted(amb),
        balls=balls,
        mount=None if mount is None else os.fspath(mount),
        axial=axial,
        inclination=to_si(inclination, "rad", "inclination"),
        controller=controller,
        **numbers,
    )
    path = Path(os.fspath(folder))
    built = machine(request, path.absolute().name)
    for note in [*bare_speeds([speed]), *built.notes]:
        warnings.warn(note, stacklevel=2)
    return load(write(built, path, force))


def import_rotor(
    source: PathLike | Any,
    at: Places | None = None,
    amb: Places | None = None,
    sensors: Places | None = None,
    speed: Spin | None = None,
) -> Rotor:
    """Import a rotor from ROSS, a table of its sections, matrices or modal data.

    source: saved by ROSS (.toml, .json), a table of sections (.csv), matrices or modal data (.npz), or a
        folder of matrices (.mtx, .hb, .matrix); in Python also a `ross.Rotor`, or arrays by name
    at: stations that touchdown bearings hold; a PLACE is a node, from 1, or its name in the file, or a
        distance from node 1 such as 120 mm
    amb: the same of the magnetic bearings that levitate it before; `touchdown new` takes the NAMEs alone
    sensors: places whose motion is recorded
    speed: at which ROSS's bearings are taken, where they depend on it

    The rotor's `about` says what is left out or otherwise. Raises TouchdownError.

    >>> with open("pump.csv", "w") as file:
    ...     print("length [mm], outer diameter [mm], material", "300, 30, steel", sep=chr(10), file=file)
    >>> rotor = touchdown.import_rotor("pump.csv", at={"A": "20 mm", "B": "280 mm"})
    >>> rotor
    <Rotor pump: 12 elements, 13 nodes, 1.6604 kg, 0.3 m, stations: A at node 2, B at node 12>
    """
    from ...master.common.units import to_si
    from ...studies.rotor.scene_report import import_rotor
    from .rotor import Rotor

    spin = None if speed is None else to_si(speed, "rad/s", "speed")
    return Rotor.of(import_rotor(source, at, amb, sensors, spin))


def import_mount(source: PathLike, *, slides: Count = 4) -> ImportedMount:
    """Fit a mount to its measured loop of force over displacement.

    source: table (.csv) with columns such as "displacement [mm]" and "force [N]"
    slides: number of slides that a mount may have, 1 to 4 (default: 4)

    `fit` of what it returns has the springs and slides, `save(path)` writes a mount's file and a picture of
    loop and fit. Raises TouchdownError.

    >>> import numpy
    >>> up = numpy.linspace(-0.1, 0.1, 41)  # mm
    >>> loading = numpy.minimum(1e4 * (up + 0.1), 500.0) - 250.0  # N
    >>> loop = numpy.column_stack([[*up, *up[::-1]], [*loading, *-loading]])
    >>> numpy.savetxt("loop.csv", loop, delimiter=",", header="displacement [mm],force [N]", comments="")
    >>> stiffness, force = touchdown.import_mount("loop.csv", slides=1).fit.slides[0]
    >>> round(force)  # N
    250
    """
    from ...studies.machine.mount_file import ImportedMount

    return ImportedMount.read(Path(source), slides)


def import_foundation(
    source: PathLike, at: Places, *, modes: Count = 8, damping: Fraction = 0.01
) -> ImportedFoundation:
    """Import the modes of a foundation from matrices or modal data.

    source: folder of matrices (.mtx, .hb, .matrix), or matrices or modal data (.npz)
    at: seats, A to D, on which bearings stand, and the node of the foundation for each
    modes: largest number of a foundation's modes, the slowest that move a seat (default: 8)
    damping: ratio of a foundation, where the file gives none (default: 0.01)

    `save(path)` of what it returns writes a file of settings. Raises TouchdownError.

    >>> import numpy
    >>> numpy.savez("frame.npz", frequencies=[50.0], x=[[0.1], [0.2]], y=[[0.0], [0.0]])
    >>> touchdown.import_foundation("frame.npz", {"A": 2}).save("frame.toml").name
    'frame.toml'
    """
    from ...master.common.units import to_si
    from ...studies.machine.foundation_file import ImportedFoundation

    return ImportedFoundation.read(Path(source), at, modes, to_si(damping, "1", "damping"))


def report(
    run: Result | Sweep | PathLike, path: PathLike | None = None, *, pdf: bool = False, short: bool = False
) -> list[Path]:
    """Write the report of a run or a sweep as one HTML page.

    run: its folder; in Python also itself
    path: of the page
    pdf: also print it to PDF, beside the page, with a Chromium on the PATH
    short: of a run, about four pages to send to a customer (default name: report-short.html)

    Returns the files; a page needs nothing beside it. Raises TouchdownError where there is no such run, or
    it cannot be written or printed.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> [path.name for path in touchdown.report(result, "drop.html")]
    ['drop.html']
    """
    from ...reports.page import PAGE, SHORT_PAGE, browser, make_room, print_page, report_on, write_page
    from ...reports.sweeps import report_on_sweep
    from ...studies.sweep.definition import DEFINITION_FILE
    from ...studies.sweep.results import Sweep, read

    if pdf:
        browser()  # first of all: a page takes seconds
    if not isinstance(run, (str, os.PathLike)):
        found = run
    else:
        found = read(Path(run)) if os.path.isfile(Path(run, DEFINITION_FILE)) else open_result(run)
    if isinstance(found, Sweep) and short:
        raise TouchdownError(
            f"{found.folder} is a sweep, which has no short report; give the folder of a run"
        )
    page = Path(path) if path else found.folder / (SHORT_PAGE if short else PAGE)
    make_room(page)
    write_page(report_on_sweep(found) if isinstance(found, Sweep) else report_on(found, short), page)
    return [page, print_page(page, page.with_suffix(".pdf"))] if pdf else [page]


def animate(run: Result | PathLike, path: PathLike | None = None, *, progress: bool = False) -> Path:
    """Make a film of a run.

    run: its folder; in Python also its result
    path: of the film, .gif or .mp4, which takes ffmpeg, from the PATH or the extra `animate`

    Rotor, ring, balls and cage turn, an arrow is the force on the journal, and the first impact goes
    slowly. Returns its path. Raises TouchdownError where nothing touched, or the film cannot be made.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> touchdown.animate(touchdown.run(scene, in_process=True), "drop.gif").name
    'drop.gif'
    """
    from ...reports.animation import checked_suffix, film_frames, write_film
    from ...reports.layout import Absent
    from ...reports.motion import motions
    from ...reports.subject import Subject

    result = open_result(run) if isinstance(run, (str, os.PathLike)) else run
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


def view(run: Result | PathLike, path: PathLike | None = None) -> Path:
    """Write the drop as it moves, linked to its curves, as one HTML page.

    run: its folder; in Python also its result
    path: of the page

    Rotor, ring, balls, cage and forces of the whole run beside curves of force, displacement, gaps and
    speeds; to play, slow down, step through and zoom in a browser, without network or server. Returns its
    path. Raises TouchdownError where there is no such run, no bearing of it can be drawn, or the page
    cannot be written.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> touchdown.view(touchdown.run(scene, in_process=True), "drop.html").name
    'drop.html'
    """
    from ...reports.page import make_room, write_page
    from ...reports.view import VIEW, view_of

    result = open_result(run) if isinstance(run, (str, os.PathLike)) else run
    page = Path(path) if path else result.folder / VIEW
    make_room(page, VIEW)
    return write_page(view_of(result), page)


def diff(runs: Texts | Iterable[Result], folder: PathLike | None = None) -> Differences:
    """Compare runs: the settings they differ in, and the quantities.

    runs: folders of runs, the first of which the others are compared with, or drops of sweeps, as
        FOLDER/NUMBER; in Python also results
    folder: for pictures of all in one: forces, orbits, gaps; without one there are none

    `settings` of what it returns are those that differ, `to_pandas()` has all quantities in SI. Raises
    TouchdownError where there is no such run.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> heavier = touchdown.run(scene.set({"rotor.mass": "2 kg"}), in_process=True)
    >>> touchdown.diff([touchdown.run(scene, in_process=True), heavier]).settings
    {'rotor.mass': ['1.65 kg', '2 kg']}
    """
    from ...master.common.files import make_writable
    from ...studies.drop.differences import differences

    found = differences(runs or ())
    if folder is not None:
        make_writable(Path(folder))
        found.findings().write(Path(folder))
    return found


def export(
    run: Result | PathLike,
    path: PathLike | None = None,
    *,
    to: Literal["csv", "xlsx", "mat", "parquet"] | None = None,
) -> Path:
    """Write what a run recorded as a table, with units in the heads of its columns.

    run: its folder; in Python also its result
    path: of the table
    to: its format (default: by the ending of the path, or csv); xlsx takes openpyxl, parquet pyarrow

    Values are in SI, over the time from the scene's zero. Returns the path. Raises TouchdownError where
    there is no such run, the library is not installed, or it cannot be written.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "2 ms"})
    >>> touchdown.export(touchdown.run(scene, in_process=True), "drop.mat").name
    'drop.mat'
    """
    from ...master.results import export

    result = open_result(run) if isinstance(run, (str, os.PathLike)) else run
    form = to or (Path(path).suffix[1:] if path else "csv")
    return export.export(result, Path(path) if path else result.folder / f"result.{form}", form)
