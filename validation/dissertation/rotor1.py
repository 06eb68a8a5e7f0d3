"""Section 4.1: rotor I on cageless bearings out of line (Figs 12 to 15, Table 1)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from matplotlib.figure import Figure

from ...master.coupling.simulation import opened
from ...master.results.result import Result
from ...master.results.spectra import on_grid, spectral_lines, waterfall
from ...master.scene.file import load_scene
from ...master.scene.scene import Scene
from ...reports.figures.motion import orbits
from ...reports.figures.spectra import motion_waterfall
from ...reports.figures.style import sheet
from ...studies.rotor.figure import drawing
from ...studies.rotor.rotor_report import SPEED, described, find_rotor
from ..case import Found, Row
from .drop_cache import PHASES, Drops, at_phases, figure_of, finished, seats_of, whirling

SETTLES, WHIRLS = "settles", "whirls"
EDGE = "which phases whirl is decided by little; `touchdown verdict` finds the edges"
SAME = 1e-6  # of a value that the models were given
Quantity = tuple[
    str, str, str, float, float
]  # title, unit, variable, its SI unit in it, the dissertation's value


def verdict_row(what: str, source: str, runs: Sequence[Result], why: str = EDGE) -> Row:
    """Halminen's SETTLES or WHIRLS beside how many of `runs` whirl; it agrees where all do as it says.

    A single drop, as the dissertation has, tells of no phase but its own: where some runs do otherwise the
    phases that the dissertation says nothing of decide, and `why` says so.
    """
    count, every = whirling(runs), len(runs)
    return counted_row(what, source, count, every, f"{count} of {every} whirl", why)


def counted_row(what: str, source: str, count: int, every: int, ours: str, why: str = EDGE) -> Row:
    """The same of `count` that whirl of `every` phase, in the words of `ours`."""
    like = count if source == WHIRLS else every - count
    note = "" if like == every else f"so at {like} of {every} phases; {why}" if like > 0 else why
    return Row(what, "", source, ours, why=note, holds=like == every)


def orbit_sheets(runs: Sequence[Result], columns: int = 2) -> Figure:
    """The orbits at both seats of each run, one run beside or below the other."""
    rows = -(-len(runs) // columns)
    figure = sheet(11.4 * columns, 6.7 * rows)
    parts = figure.subfigures(rows, columns, squeeze=False).flat
    for part, run in zip(parts, runs, strict=False):
        orbits(part, finished(run), seats_of(run))
    return figure


def given_rows(
    scene: str, before: str, quantities: Sequence[Quantity], why: Mapping[str, str] | None = None
) -> list[Row]:
    """A scene's parameters beside the printed ones; why: by variable."""
    with opened(load_scene(scene), in_process=True) as system:
        return [
            Row(
                before + title,
                unit,
                printed,
                factor * system.value(variable),
                SAME,
                (why or {}).get(variable, ""),
            )
            for title, unit, variable, factor, printed in quantities
        ]


SURROGATE = "lengths and diameters are fitted: the drawing's cannot be read"
FITTED = "fitted to it"
MACHINE: Sequence[Quantity] = (
    ("clearance", "mm", "bearing_A.clearance", 1e3, 0.3),
    ("housing's stiffness", "N/m", "housing_A.stiffness", 1.0, 2.5e8),
    ("housing's damping", "N.s/m", "housing_A.damping", 1.0, 2500.0),
    ("housing's mass", "kg", "housing_A.mass", 1.0, 5.0),
    ("contact stiffness", "N/m^(10/9)", "bearing_A.contact.stiffness", 1.0, 2.4e9),
    ("dissipation of the contact", "s/m", "bearing_A.contact.dissipation", 1.0, 0.12),
)


def fig_12(drops: Drops) -> Found:
    """Side view to scale, and what the text states of the machine."""
    properties = described(find_rotor("rotor_I"), SPEED, modes=5)
    shaft, bending = properties.shaft, float(properties.frequencies[2])
    figure = sheet()
    drawing(figure, shaft)
    rows = [
        Row("mass", "kg", 3.3, shaft.mass, 0.005, FITTED),
        Row("polar inertia", "kg.m2", 0.001, shaft.polar_inertia, 0.005, FITTED),
        Row("diametral inertia", "kg.m2", 0.017, shaft.diametral_inertia, 0.005, FITTED),
        Row("first bending frequency", "Hz", 1600.0, bending, 0.01, FITTED),
        Row("unbalance", "g.mm", 3.0, 1e6 * sum(one.moment for one in shaft.unbalances), SAME),
    ]
    return Found([*rows, *given_rows("rotor1-9000", "", MACHINE)], figure, [SURROGATE])


DURATION = 0.5  # s
SPEEDS = (9000, 18000)  # rpm
FIG_13_NOTES = [
    "bearings in line: the measured misalignment stands in the dissertation's picture alone",
    "as in the rig, a bearing without a cage at A and one with a cage at B; Halminen's own c and d have "
    "none with a cage",
]


def fig_13(drops: Drops) -> Found:
    """Parts c and d: simulated at 9000 and 18000 rpm."""
    scenes = [load_scene(f"rotor1-measured-{speed}").set({"run.duration": DURATION}) for speed in SPEEDS]
    runs = [drops.of(at_phases(scene, 4)) for scene in scenes]
    rows: list[Row] = []
    for part, speed, members in zip("cd", SPEEDS, runs, strict=True):
        rows.append(verdict_row(f"{part}) {speed} rpm, over phases of the unbalance", SETTLES, members))
        first = 1e3 * members[0].summary["seats"]["A"]["first_contact_time"]
        rows.append(Row(f"{part}) {speed} rpm, first contact at A", "ms", None, first))
    return Found(rows, orbit_sheets([members[0] for members in runs]), FIG_13_NOTES)


SOURCE = {0: SETTLES, 75: SETTLES, 150: SETTLES, 225: WHIRLS}  # by misalignment of each bearing (um)
FIG_14_NOTES = [
    f"verdicts over {PHASES} phases of the unbalance; `touchdown figure rotors` counts finer",
    "at 18000 rpm and -+150 um about a tenth of all phases whirls (`touchdown verdict`, "
    "docs/stability.md), but none of these six",
    "the pictures are of 9000 rpm and the first phase",
    "the dissertation does not state the speed: both of its rig's are counted",
    "rolling resistance of the balls, 0.011, fitted to the run-down of Fig 15",
]


def fig_14(drops: Drops) -> Found:
    """The four misalignments at both speeds."""
    scenes = {(speed, offset): at_phases(scene_of(speed, offset)) for speed in SPEEDS for offset in SOURCE}
    drops.of([scene for members in scenes.values() for scene in members])
    runs = {case: drops.of(members) for case, members in scenes.items()}
    rows = [
        verdict_row(f"{speed} rpm, bearings off by -+{offset} um", SOURCE[offset], members)
        for (speed, offset), members in runs.items()
    ]
    return Found(rows, orbit_sheets([runs[SPEEDS[0], offset][0] for offset in SOURCE]), FIG_14_NOTES)


def scene_of(speed: int, offset: int) -> Scene:
    """Rotor I at a speed (rpm), its bearings off by `offset` (um) to either side."""
    name = f"rotor1-{speed}" + (f"-{offset}um" if offset else "")
    return load_scene(name).set({"run.duration": DURATION})


SWINGS = (30.0, 40.0)  # Hz, the dissertation's
PENDULUM, BENDING = (20.0, 50.0, 4), (1300.0, 2000.0, 1)  # Hz, Hz, how many lines
HEIGHT = 0.05  # of the tallest line
NEAR_HZ = 2.0
FITTED_RESISTANCE = "the rolling resistance (0.011) is fitted to it; the stated models hardly slow down"
WHICH = "the dissertation does not say of which part its lines are"


def fig_15(drops: Drops) -> Found:
    """Motion at bearing 1; lines of its velocity and displacement in the first and last of eight parts."""
    (run,) = drops.of([load_scene("rotor1-waterfall")])
    figure, seat, time = sheet(), seats_of(run)[0], run.recording.time
    motion_waterfall(figure, finished(run), seat)
    speed = figure_of(run, "speed_end")
    rows = [Row("speed after 16 s", "rpm", 7780.0, speed, 0.016, FITTED_RESISTANCE)]
    grid = on_grid(time) & (time >= -1e-9)
    frequency, _, x = waterfall(time[grid], run.recording[seat.motion("x")][grid])
    _, _, vx = waterfall(time[grid], run.recording[seat.motion("vx")][grid])
    for name, part in (("first", 0), ("last", -1)):
        for source, found in nearest_lines(SWINGS, spectral_lines(frequency, x[part], *PENDULUM)):
            why = WHICH if found is not None else f"no line near it; {WHICH}"
            rows.append(
                Row(f"{name} 2 s: line of the displacement", "Hz", source, found, NEAR_HZ / source, why)
            )
        ((bending, _),) = spectral_lines(frequency, vx[part], *BENDING)
        rows.append(Row(f"{name} 2 s: line of the velocity", "Hz", 1600.0, bending, 0.02))
    return Found(rows, figure)


def nearest_lines(
    sources: Sequence[float], found: Sequence[tuple[float, float]]
) -> Iterator[tuple[float, float | None]]:
    """Each of Halminen's lines (Hz), ascending, with the one of `found` (Hz, height) that belongs to it.

    A line belongs to Halminen's that is nearest to it; of several the tallest, None where there is none.
    Lower than HEIGHT of the tallest there is no line in a picture.
    """
    least = HEIGHT * max((height for _, height in found), default=0.0)
    for source in sources:
        near = [
            (height, hertz)
            for hertz, height in found
            if height >= least and min(sources, key=lambda other: abs(other - hertz)) == source
        ]
        yield source, max(near)[1] if near else None


TABLE_1: Mapping[str, Sequence[float]] = {"6004": (31.0, 6.4, 9.0, 5.0), "6904": (26.1, 4.8, 17.0, 0.0)}
QUANTITIES = (
    ("pitch diameter", "mm", "bearing.balls.pitch_diameter", 1e3),
    ("ball diameter", "mm", "bearing.balls.diameter", 1e3),
    ("number of balls", "", "bearing.balls.count", 1.0),
    ("diametral clearance of the balls", "um", "bearing.balls.play", 2e6),
)
WHY = {
    "6904": {
        "bearing.balls.pitch_diameter": "17 balls do not fit on 26.1 mm; mean of bore and outside diameter"
    },
    "6004": {
        "bearing.balls.play": "the 5 um are read as radial play, which gives Table 7 and the loaded balls"
    },
}


def table_1(drops: Drops) -> Found:
    """The scenes' bearings beside the printed table."""
    rows: list[Row] = []
    for bearing, scene in {"6004": "disk-caged-detailed", "6904": "disk-cageless-detailed"}.items():
        quantities = [(*q, printed) for q, printed in zip(QUANTITIES, TABLE_1[bearing], strict=True)]
        rows += given_rows(scene, f"{bearing}: ", quantities, WHY[bearing])
    return Found(rows)
