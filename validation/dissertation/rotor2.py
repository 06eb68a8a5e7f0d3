"""Section 4.2: stresses in rotor II (Figs 17 to 20, Tables 2 to 4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...master.coupling.simulation import opened
from ...master.quantities import STRESSES, Summary
from ...master.results.final_state import FinalState
from ...master.results.result import Result
from ...master.results.stresses import along
from ...master.results.summary import relative_orbit
from ...master.scene.scene import Scene
from ...reports.figures.stress import draw_along
from ...reports.figures.style import sheet
from ...studies.rotor.figure import draw_rest, drawing, modes
from ...studies.rotor.rotor_report import SPEED, described, find_rotor
from ..case import Found, Row
from . import stress_readings as read
from .drop_cache import PHASES, SEATS, Drops, at_phases, numbers, seats_of
from .rotor1 import FITTED, SAME, SETTLES, SURROGATE, WHIRLS, given_rows, orbit_sheets, verdict_row
from .stress_readings import BENDING, COLUMNS, HEADERS, SHORT, SOURCE, WAIT, as_read, read_as

ASSUMED = "assumed offsets, and in case 3b an assumed drag, make it whirl"
AS_PRINTED = "with the offsets, the friction and no drag as printed nothing whirls"
BELOW = " (below)"  # what `touchdown figure rotors` prints there
CASES = tuple(SOURCE)  # "1", "2", "3a", "3b"
AT_PEAK = tuple(read.AT_FIRST_PEAK)  # those of them that are read at the first distinct peak
LATE = tuple(case for case in CASES if case not in AT_PEAK)


def _whirls(case: str) -> bool:
    """Whether it does in the dissertation."""
    return not SOURCE[case][-1].startswith("no")


def _notes() -> list[str]:
    """Notes on the assumptions of the dissertation's reading."""
    texts = [
        f"{' '.join(a.about.split())}; because: {a.because.removesuffix(BELOW)}" for a in read.ASSUMPTIONS
    ]
    return ["the rotor is a surrogate: the lengths and diameters of Fig 18 cannot be read", *texts]


def _as_printed(case: str) -> Scene:
    """A case as the dissertation states it, with what it leaves open as the scene has it."""
    return read_as(case, {})


def _reading_row(case: str, runs: Sequence[Result], printed: bool = False) -> Row:
    """Whether a case whirls as the dissertation reads it, with what was assumed for that, or as printed."""
    source, what = WHIRLS if _whirls(case) else SETTLES, "printed" if printed else "read"
    row = verdict_row(f"case {case}, as {what}: whirl", source, runs, *([AS_PRINTED] if printed else []))
    return replace(row, why=ASSUMED) if _whirls(case) and not printed else row


BEYOND, RADIUS = 750.0, 1100.0  # um, in case 3b
DRAGGED = "the drag that keeps the whirl alive is an assumption, and decides how far it grows"
BOUNCES = "how high it bounces depends on the phase of the unbalance"
NDE = 0  # the first seat, A


def fig_17(drops: Drops) -> Found:
    """The four cases as the dissertation reads them, drawn; and as printed, counted."""
    assumed, printed = (
        {case: at_phases(scene_of(case)) for case in CASES} for scene_of in (as_read, _as_printed)
    )
    drops.of([scene for members in (*assumed.values(), *printed.values()) for scene in members])
    runs = {case: drops.of(members) for case, members in assumed.items()}
    rows = [_reading_row(case, members) for case, members in runs.items()]
    rows += [_reading_row(case, drops.of(members), printed=True) for case, members in printed.items()]
    rows += [_bounce(case, runs[case][0]) for case in ("1", "2")]
    rows += _whirl(runs["3b"][0])
    lines = [*_notes(), f"verdicts over {PHASES} phases of the unbalance; the pictures are of the first"]
    return Found(rows, orbit_sheets([members[0] for members in runs.values()]), lines)


def _bounce(case: str, run: Result) -> Row:
    """How high the non-drive end bounces, of the clearance."""
    seat = seats_of(run)[NDE]
    _, y = relative_orbit(run.ending, seat, run.recording)
    landed = run.recording.time > run.summary["seats"][SEATS[NDE]]["first_contact_time"]
    share = float(np.max(y[landed])) / run.ending.value(f"{seat.bearing}.clearance")
    what, ours = (
        f"case {case}: highest bounce at the NDE",
        f"{share:+.2f} of the clearance above the middle",
    )
    return Row(what, "", "very near the top", ours, why=BOUNCES, holds=share > 0.8)


def _whirl(run: Result) -> list[Row]:
    """How far out the whirl of case 3b goes at the non-drive end."""
    seat, time = seats_of(run)[NDE], run.recording.time
    radius = 1e6 * np.hypot(*(run.recording[seat.motion(axis)] for axis in "xy"))
    largest, kept = float(np.max(radius)), float(np.median(radius[time > 0.75 * time[-1]]))
    return [
        Row("case 3b: largest displacement at the NDE", "um", (BEYOND, np.inf), largest, why=DRAGGED),
        Row("case 3b: distance that the whirl keeps, last quarter", "um", RADIUS, kept, 0.15, DRAGGED),
    ]


NODES = {"touchdown bearing, NDE": ("A", 2), "touchdown bearing, DE": ("B", 25)}
MAGNETS = {"amb_A": (7, 11), "amb_B": (19, 23)}  # laminations between these nodes
UNBALANCES = (1.07, 2.78, 4.56)  # g.mm: axial disc, middle, gear


def fig_18(drops: Drops) -> Found:
    """Side view to scale, and the nodes and masses that the text states."""
    shaft = described(find_rotor("rotor_II"), SPEED, modes=5).shaft
    figure = sheet()
    drawing(figure, shaft)
    disc = max(shaft.points, key=lambda point: point.polar_inertia)
    rows = [Row(f"node of the {what}", "", node, shaft.node(name)) for what, (name, node) in NODES.items()]
    rows.append(Row("node of the axial magnetic bearing's disc", "", 4, disc.node))
    rows += [
        Row(f"node in the middle of {name}, laminations", "", ends, shaft.node(name))
        for name, ends in MAGNETS.items()
    ]
    rows += [
        Row("mass", "kg", 106.0, shaft.mass, 0.005, FITTED),
        Row("polar inertia", "kg.m2", 0.4, shaft.polar_inertia, 0.005, FITTED),
    ]
    rows += [
        Row(f"unbalance at node {unbalance.node}", "g.mm", printed, 1e6 * unbalance.moment, SAME)
        for printed, unbalance in zip(UNBALANCES, shaft.unbalances, strict=True)
    ]
    return Found(rows, figure, [SURROGATE])


MOTOR = (323.5, 571.4)  # mm, the surrogate's middle part
ZERO = 1e-3  # of the largest stress


def fig_19(drops: Drops) -> Found:
    """The rotor at rest; how far its bearings give way stands in the rows."""
    properties = described(find_rotor("rotor_II"), SPEED, modes=5)
    lying, shaft = properties.rest, properties.shaft
    assert lying is not None
    figure = sheet()
    draw_rest(figure, properties)
    stress, position = np.abs(lying.bending), 1e3 * lying.position
    largest = float(np.max(stress))
    ends = float(max(stress[0], stress[-1])) / largest
    inside = float(np.max(stress[(position > MOTOR[0]) & (position < MOTOR[1])])) / largest
    with opened(_as_printed("1"), in_process=True) as system:  # how far the housings' springs give way
        a, b = (
            1e6 * load / system.value(f"housing_{seat}.stiffness")
            for load, seat in zip(lying.reactions, "AB", strict=True)
        )
    towards = shaft.centre_of_mass / float(shaft.positions()[-1])
    place, sags = (
        f"at {towards:.2f} of the length from the NDE",
        f"NDE {a:.2f}, DE {b:.2f} um on the housings' springs",
    )
    fitted = "of the surrogate, whose lengths are fitted" if towards >= 0.5 else ""
    low = f"{inside:.2f} of the largest"
    rows = [
        Row("bending stress at the ends", "", "zero", f"{ends:.1g} of the largest", holds=ends < ZERO),
        Row("bending stress in the motor's part", "", "low", low, holds=inside < 0.5),
        Row("centre of mass", "", "on the NDE side", place, why=fitted, holds=towards < 0.5),
        Row("bearings' nodes give way", "", "not equally", sags, holds=abs(a - b) > 0.1 * max(a, b)),
        Row("largest bending stress", "MPa", None, 1e-6 * largest),
    ]
    return Found(rows, figure, ["the picture holds the seats rigidly; lengths and diameters are fitted"])


FIRST_HALF = (1, 13)  # nodes of the non-drive end's half
QUOTED = '"at the NDE side, near where the lamination ends"'
ONE_DROP = "one phase of the unbalance; Table 4 has the medians"


def fig_20(drops: Drops) -> Found:
    """Stresses along the rotor at the instants of Table 4, one drop of each case."""
    endings: dict[str, FinalState] = {
        case: read.first_peak(as_read(case).set(SHORT))[1] for case in AT_PEAK
    }
    endings |= {
        case: run.ending for case, run in zip(LATE, drops.of(list(map(as_read, LATE))), strict=True)
    }
    figure = sheet(13.0, 3.4 * len(CASES))
    grid = figure.subplots(len(CASES), len(STRESSES), sharex=True)
    where: list[Row] = []
    sizes: list[Row] = []
    for case, row in zip(CASES, grid, strict=True):
        rotor = endings[case].components["rotor"]
        for kind, axes in zip(STRESSES, row, strict=True):
            draw_along(axes, rotor, kind, kept=True)
            axes.set_title(f"case {case}: {kind}")
        nodes, values = along(rotor, "bending_y")
        what, sizes_at = f"case {case}: node of the largest vertical bending stress", np.abs(values)
        where.append(Row(what, "", FIRST_HALF, nodes[int(np.argmax(sizes_at))], why=QUOTED))
        what, size = f"case {case}: largest vertical bending stress", 1e-6 * float(np.max(sizes_at))
        sizes.append(Row(what, "MPa", SOURCE[case][0], size, NEAR, ONE_DROP))
    return Found([*where, *sizes], figure, [*_notes(), ONE_DROP])


MEASURED = ((661.0, 670.0), (1096.0, 1130.0), (2406.0, 2427.0), (2857.0, 2895.0))  # Hz, two planes
SYMMETRIC = "the dissertation's own model differs as much: it is symmetric, the rotor is not quite"
RIGID = 2


def table_2(drops: Drops) -> Found:
    """The surrogate's, beside the dissertation's simulated and measured ones."""
    properties = described(find_rotor("rotor_II"), SPEED, modes=RIGID + len(BENDING))
    ours = [float(value) for value in properties.frequencies[RIGID:]]
    figure = sheet()
    modes(figure, properties)
    rows = [
        Row(f"bending mode {k}, simulated", "Hz", source, computed, 0.005, FITTED)
        for k, (source, computed) in enumerate(zip(BENDING, ours, strict=True), start=1)
    ]
    rows += [
        Row(f"bending mode {k}, measured", "Hz", measured, computed, why=SYMMETRIC)
        for k, (measured, computed) in enumerate(zip(MEASURED, ours, strict=True), start=1)
    ]
    return Found(rows, figure)


PLACES = {"A": "6014, NDE", "B": "7914, DE"}
QUANTITIES = (  # title, unit, variable with {} for the seat, its SI unit in it, values at A and B
    ("bearings side by side", "", "bearing_{}.balls.rows", 1.0, (1.0, 2.0)),
    ("number of balls", "", "bearing_{}.balls.count", 1.0, (11.0, 11.0)),
    ("pitch diameter", "mm", "bearing_{}.balls.pitch_diameter", 1e3, (90.0, 85.0)),
    ("ball diameter", "mm", "bearing_{}.balls.diameter", 1e3, (12.0, 11.7)),
    ("diametral clearance of the balls", "um", "bearing_{}.balls.play", 2e6, (15.0, 9.0)),
    ("radial conformity ratio", "", "bearing_{}.balls.conformity", 1.0, (1.04, 1.04)),
    ("static load rating of a bearing", "N", "bearing_{}.rolling.static_rating", 1.0, (31000.0, 20900.0)),
    ("damping of the bearings together", "N.s/m", "bearing_{}.damping", 1.0, (300.0, 2.0 * 270.0)),
    ("housing's damping", "N.s/m", "housing_{}.damping", 1.0, (8418.0, 7755.0)),
    ("housing's stiffness", "N/m", "housing_{}.stiffness", 1.0, (67e6, 37e6)),
    ("housing's mass", "kg", "housing_{}.mass", 1.0, (6.61, 10.16)),
    ("clearance of the rotor", "mm", "bearing_{}.clearance", 1e3, (0.25, 0.25)),
)


def table_3(drops: Drops) -> Found:
    """The scene's bearings and housings beside the printed table."""
    rows: list[Row] = []
    for k, (seat, place) in enumerate(PLACES.items()):
        of_seat = [(title, unit, name.format(seat), si, v[k]) for title, unit, name, si, v in QUANTITIES]
        rows += given_rows("rotor2-case1", f"{place}: ", of_seat)
    return Found(rows)


NEAR = 0.5  # of the dissertation's value
WHIRL_STRESS = "how a whirl's stress lies in the planes is the instant's; in 3b the drag decides how much"
WHOLE = "the later and larger peak, with all modes, friction and offsets as printed"


def table_4(drops: Drops) -> Found:
    """Medians over phases as Halminen reads each case; then what is largest in the drops as printed."""
    peaks = read.at_first_peak(drops, [(as_read(case), WAIT) for case in AT_PEAK], PHASES)
    figures: dict[str, Sequence[Summary]] = dict(zip(AT_PEAK, peaks, strict=True))
    figures |= {case: [run.summary for run in drops.of(at_phases(as_read(case)))] for case in LATE}
    rows: list[Row] = []
    for case in CASES:
        why = WHIRL_STRESS if _whirls(case) else ""
        for header, source, ours in zip(
            HEADERS, SOURCE[case][:4], read.medians(figures[case]), strict=True
        ):
            rows.append(Row(f"case {case}: {header}", "MPa", source, ours, NEAR, why))
    for case in CASES:
        printed = [run.summary for run in drops.of(at_phases(_as_printed(case)))]
        largest = read.median(numbers(printed, COLUMNS[0]))
        rows.append(
            Row(f"case {case} as printed: {HEADERS[0]}", "MPa", SOURCE[case][0], largest, why=WHOLE)
        )
        rows.append(_reading_row(case, drops.of(at_phases(as_read(case)))))
    return Found(rows, notes=[*_notes(), f"medians over {PHASES} phases of the unbalance"])
