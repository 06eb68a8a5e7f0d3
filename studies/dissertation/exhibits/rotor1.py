"""Section 4.1: rotor I on cageless bearings out of line (Figs 12 to 15, Table 1)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from matplotlib.figure import Figure

from ....master.coupling.simulation import opened
from ....master.results.result import Result
from ....master.results.spectra import lines, on_grid, waterfall
from ....master.scene.file import load_scene
from ....master.scene.scene import Scene
from ....reports.figures.motion import orbits
from ....reports.figures.spectra import motion_waterfall
from ....reports.figures.style import sheet
from ...rotor.figure import drawing
from ...rotor.report import SPEED, described, find_rotor
from .exhibit import PHASES, Drops, Exhibit, Row, at_phases, figure_of, finished, seats_of, whirling

SETTLES, WHIRLS = "settles", "whirls"
EDGE = "which phases whirl is decided by little; `touchdown verdict` finds the edges"


def verdict_row(what: str, source: str, runs: Sequence[Result], why: str = EDGE) -> Row:
    """The source's SETTLES or WHIRLS beside how many of `runs` whirl; it agrees where all do as it says.

    A single drop, as the source has, tells of no phase but its own: where some runs do otherwise the
    phases that the source says nothing of decide, and `why` says so.
    """
    count, every = whirling(runs), len(runs)
    return counted_row(what, source, count, every, f"{count} of {every} whirl", why)


def counted_row(what: str, source: str, count: int, every: int, ours: str, why: str = EDGE) -> Row:
    """The same of `count` that whirl of `every` phase, in the words of `ours`."""
    like = count if source == WHIRLS else every - count
    note = "" if like == every else f"so at {like} of {every} phases; {why}" if like > 0 else why
    return Row(what, source, ours, holds=like == every, why=note)


def orbit_sheets(runs: Sequence[Result], columns: int) -> Figure:
    """The orbits at both seats of each run, one run beside or below the other."""
    rows = -(-len(runs) // columns)
    figure = sheet(11.4 * columns, 6.7 * rows)
    parts = figure.subfigures(rows, columns, squeeze=False).flat
    for part, run in zip(parts, runs, strict=False):
        orbits(part, finished(run), seats_of(run))
    return figure


SURROGATE = "lengths and diameters are fitted: the drawing's cannot be read"
FITTED = "fitted to it"


def fig_12(drops: Drops) -> Exhibit:
    """Side view to scale, and what the text states of the machine."""
    properties = described(find_rotor("rotor_I"), SPEED, modes=5)
    shaft, bending = properties.shaft, float(properties.frequencies[2])
    figure = sheet()
    drawing(figure, shaft)
    rows = [
        Row("mass [kg]", 3.3, shaft.mass, near=0.005, why=FITTED),
        Row("polar inertia [kg.m2]", 0.001, shaft.polar_inertia, near=0.005, why=FITTED),
        Row("diametral inertia [kg.m2]", 0.017, shaft.diametral_inertia, near=0.005, why=FITTED),
        Row("first bending frequency [Hz]", 1600.0, bending, near=0.01, why=FITTED),
        Row("unbalance [g.mm]", 3.0, 1e6 * sum(one.moment for one in shaft.unbalances), near=1e-6),
        *_machine(),
    ]
    return Exhibit(figure, rows, [SURROGATE])


def _machine() -> list[Row]:
    """The scene's settings of housings and contact."""
    with opened(load_scene("rotor1-9000"), in_process=True) as system:
        value = system.value
        return [
            Row("clearance [mm]", 0.3, 1e3 * value("bearing_A.clearance"), near=1e-6),
            Row("housing's stiffness [N/m]", 2.5e8, value("housing_A.stiffness"), near=1e-6),
            Row("housing's damping [N.s/m]", 2500.0, value("housing_A.damping"), near=1e-6),
            Row("housing's mass [kg]", 5.0, value("housing_A.mass"), near=1e-6),
            Row("contact stiffness [N/m^(10/9)]", 2.4e9, value("bearing_A.contact.stiffness"), near=1e-6),
            Row(
                "dissipation of the contact [s/m]", 0.12, value("bearing_A.contact.dissipation"), near=1e-6
            ),
        ]


FIG_13_DURATION = 0.5  # s
FIG_13_NOTES = [
    "bearings in line: the measured misalignment stands in the source's picture alone",
    "as in the rig, a bearing without a cage at A and one with a cage at B; the source's own c and d have "
    "none with a cage",
]


def fig_13(drops: Drops) -> Exhibit:
    """Parts c and d: simulated at 9000 and 18000 rpm."""
    scenes = [
        load_scene(f"rotor1-measured-{speed}").set({"run.duration": FIG_13_DURATION})
        for speed in (9000, 18000)
    ]
    runs = [drops.over_phases(scene, 4) for scene in scenes]
    rows: list[Row] = []
    for part, speed, members in zip("cd", (9000, 18000), runs, strict=True):
        rows.append(verdict_row(f"{part}) {speed} rpm, over phases of the unbalance", SETTLES, members))
        first = members[0].summary["first_contact_time_s_bearing_A"]
        rows.append(Row(f"{part}) {speed} rpm, first contact at A [ms]", None, 1e3 * float(str(first))))
    return Exhibit(orbit_sheets([members[0] for members in runs], 2), rows, FIG_13_NOTES)


DURATION = 0.5  # s
SPEEDS = (9000, 18000)  # rpm
SOURCE = {0: SETTLES, 75: SETTLES, 150: SETTLES, 225: WHIRLS}  # by misalignment of each bearing (um)
FIG_14_NOTES = [
    f"verdicts over {PHASES} phases of the unbalance; `touchdown figure rotors` counts finer",
    "at 18000 rpm and -+150 um about a tenth of all phases whirls (`touchdown verdict`, "
    "docs/stability.md), but none of these six",
    "the pictures are of 9000 rpm and the first phase",
    "the source does not state the speed: both of its rig's are counted",
    "rolling resistance of the balls, 0.011, fitted to the run-down of Fig 15",
]


def fig_14(drops: Drops) -> Exhibit:
    """The four misalignments at both speeds."""
    cases = [(speed, offset) for speed in SPEEDS for offset in SOURCE]
    scenes = {case: at_phases(scene_of(*case)) for case in cases}
    drops.of([scene for members in scenes.values() for scene in members])
    runs = {case: drops.of(members) for case, members in scenes.items()}
    rows: list[Row] = [
        verdict_row(f"{speed} rpm, bearings off by -+{offset} um", SOURCE[offset], members)
        for (speed, offset), members in runs.items()
    ]
    slow = [members[0] for (speed, _), members in runs.items() if speed == SPEEDS[0]]
    return Exhibit(orbit_sheets(slow, 2), rows, FIG_14_NOTES)


def scene_of(speed: int, offset: int) -> Scene:
    """Rotor I at a speed (rpm), its bearings off by `offset` (um) to either side."""
    name = f"rotor1-{speed}" + (f"-{offset}um" if offset else "")
    return load_scene(name).set({"run.duration": DURATION})


SWINGS = (30.0, 40.0)  # Hz, the source's
PENDULUM, BENDING = (20.0, 50.0, 4), (1300.0, 2000.0, 1)  # Hz, Hz, how many lines
HEIGHT = 0.05  # of the tallest line
NEAR_HZ = 2.0
FITTED_RESISTANCE = "the rolling resistance (0.011) is fitted to it; the stated models hardly slow down"
WHICH = "the source does not say of which part its lines are"
PARTS = (("first", 0), ("last", -1))


def fig_15(drops: Drops) -> Exhibit:
    """Velocity and displacement at bearing 1 in eight parts of 2 s."""
    (run,) = drops.of([load_scene("rotor1-waterfall")])
    figure, seat = sheet(), seats_of(run)[0]
    motion_waterfall(figure, finished(run), seat)
    rows = [
        Row(
            "speed after 16 s [rpm]",
            7780.0,
            figure_of(run, "rotor_speed_end_rpm"),
            near=0.016,
            why=FITTED_RESISTANCE,
        )
    ]
    grid = on_grid(run.recording.time) & (run.recording.time >= -1e-9)
    frequency, _, x = waterfall(run.recording.time[grid], run.recording[seat.motion("x")][grid])
    _, _, vx = waterfall(run.recording.time[grid], run.recording[seat.motion("vx")][grid])
    for name, part in PARTS:
        for source, found in nearest_lines(SWINGS, lines(frequency, x[part], *PENDULUM)):
            rows.append(
                Row(
                    f"{name} 2 s: line of the displacement [Hz]",
                    source,
                    found,
                    near=NEAR_HZ / source,
                    why=WHICH if found is not None else f"no line near it; {WHICH}",
                )
            )
        ((bending, _),) = lines(frequency, vx[part], *BENDING)
        rows.append(Row(f"{name} 2 s: line of the velocity [Hz]", 1600.0, bending, near=0.02))
    return Exhibit(figure, rows)


def nearest_lines(
    sources: Sequence[float], found: Sequence[tuple[float, float]]
) -> Iterator[tuple[float, float | None]]:
    """Each of the source's lines (Hz), ascending, with the one of `found` (Hz, height) that belongs to it.

    A line belongs to the source's that is nearest to it; of several the tallest, None where there is none.
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


SCENES = {"6004": "disk-caged-detailed", "6904": "disk-cageless-detailed"}
QUANTITIES = (  # title, variable of the bearing, how many of its units make one of the table's
    ("pitch diameter [mm]", "balls.pitch_diameter", 1e3),
    ("ball diameter [mm]", "balls.diameter", 1e3),
    ("number of balls", "balls.count", 1.0),
    ("diametral clearance of the balls [um]", "balls.play", 2e6),
)
TABLE_1 = {"6004": (31.0, 6.4, 9.0, 5.0), "6904": (26.1, 4.8, 17.0, 0.0)}
WHY = {
    ("6904", "balls.pitch_diameter"): "17 balls do not fit on 26.1 mm; mean of bore and outside diameter",
    ("6004", "balls.play"): "the 5 um are read as radial play, which gives Table 7 and the loaded balls",
}
SAME = 1e-6


def table_1(drops: Drops) -> Exhibit:
    """The scenes' bearings beside the printed table."""
    rows: list[Row] = []
    for bearing, name in SCENES.items():
        with opened(load_scene(name), in_process=True) as system:
            for (title, variable, factor), printed in zip(QUANTITIES, TABLE_1[bearing], strict=True):
                ours = factor * system.value(f"bearing.{variable}")
                why = WHY.get((bearing, variable), "")
                rows.append(Row(f"{bearing}: {title}", printed, ours, near=SAME, why=why))
    return Exhibit(None, rows)
