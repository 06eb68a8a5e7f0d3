"""Section 4.2: stresses in rotor II (Figs 17 to 20, Tables 2 to 4)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ....master.coupling.simulation import opened
from ....master.results.final_state import FinalState
from ....master.results.result import Result
from ....master.results.stresses import KINDS, MPA, along
from ....master.results.summary import relative_orbit
from ....master.scene.file import load_scene
from ....master.scene.scene import Scene
from ....reports.figures.stress import draw_along
from ....reports.figures.style import sheet
from ...rotor.figure import draw_rest, drawing, modes
from ...rotor.report import SPEED, described, find_rotor
from ..stress_readings import (
    ASSUMPTIONS,
    BENDING,
    COLUMNS,
    HEADERS,
    READINGS,
    SHORT,
    SOURCE,
    WAIT,
    Ensemble,
    Figures,
    final_state_at_first_peak,
    median,
    medians,
    numbers,
)
from .exhibit import PHASES, Drops, Exhibit, Row, at_phases, seats_of
from .rotor1 import SETTLES, WHIRLS, orbit_sheets, verdict_row

ASSUMED = "offsets, and in case 3b a drag, are assumed so that it does"
AS_PRINTED = "with the offsets, the friction and no drag as printed nothing whirls"
BELOW = " (below)"  # what `touchdown figure rotors` prints there
CASES = tuple(SOURCE)  # "1", "2", "3a", "3b"
WHIRLING = {case: not SOURCE[case][-1].startswith("no") for case in CASES}


def as_read(case: str) -> Scene:
    """A case as the source reads it: what that assumes is in `notes`."""
    return load_scene(f"rotor2-case{case}").set(READINGS[case][0].settings)


def as_printed(case: str) -> Scene:
    """A case as the source states it, with what it leaves open as the scene has it."""
    return load_scene(f"rotor2-case{case}")


def notes() -> list[str]:
    """Notes on the assumptions of the source's reading."""
    texts = [f"{' '.join(a.about.split())}; because: {a.because.removesuffix(BELOW)}" for a in ASSUMPTIONS]
    return ["the rotor is a surrogate: the lengths and diameters of Fig 18 cannot be read", *texts]


def reading_row(case: str, runs: Sequence[Result]) -> Row:
    """Whether a case whirls as the source reads it, over phases; with what was assumed so that it does."""
    row = verdict_row(f"case {case}, as the source reads: whirl", _source(case), runs)
    return replace(row, why=ASSUMED) if WHIRLING[case] else row


def printed_row(case: str, runs: Sequence[Result]) -> Row:
    """Whether it whirls as printed."""
    return verdict_row(f"case {case}, as printed: whirl", _source(case), runs, why=AS_PRINTED)


def _source(case: str) -> str:
    return WHIRLS if WHIRLING[case] else SETTLES


BEYOND, RADIUS = 750.0, 1100.0  # um, in case 3b
DRAG = "the drag that keeps the whirl alive is an assumption, and decides how far it grows"
NDE = 0  # the first seat, A


def fig_17(drops: Drops) -> Exhibit:
    """The four cases as the source reads them, drawn; and as printed, counted."""
    read, printed = ({case: at_phases(scene(case)) for case in CASES} for scene in (as_read, as_printed))
    drops.of([scene for members in (*read.values(), *printed.values()) for scene in members])
    runs = {case: drops.of(members) for case, members in read.items()}
    rows = [reading_row(case, members) for case, members in runs.items()]
    rows += [printed_row(case, drops.of(members)) for case, members in printed.items()]
    rows += [_bounce(case, runs[case][0]) for case in ("1", "2")]
    rows += _whirl(runs["3b"][0])
    lines = [*notes(), f"verdicts over {PHASES} phases of the unbalance; the pictures are of the first"]
    return Exhibit(orbit_sheets([members[0] for members in runs.values()], 2), rows, lines)


def _bounce(case: str, run: Result) -> Row:
    """How high the non-drive end bounces, of the clearance."""
    seat = seats_of(run)[NDE]
    _, y = relative_orbit(run.ending, seat, run.recording)
    clearance = run.ending.value(f"{seat.bearing}.clearance")
    landed = run.recording.time > float(str(run.summary[f"first_contact_time_s_{seat.bearing}"]))
    share = float(np.max(y[landed])) / clearance
    return Row(
        f"case {case}: highest bounce at the NDE",
        "very near the top",
        f"{share:+.2f} of the clearance above the middle",
        holds=share > 0.8,
        why="how high it bounces depends on the phase of the unbalance",
    )


def _whirl(run: Result) -> list[Row]:
    """How far out the whirl of case 3b goes at the non-drive end."""
    seat = seats_of(run)[NDE]
    x, y = (run.recording[seat.motion(axis)] for axis in "xy")
    radius = 1e6 * np.hypot(x, y)
    largest = float(np.max(radius))
    late = run.recording.time > 0.75 * run.recording.time[-1]
    return [
        Row(
            "case 3b: largest displacement at the NDE [um]",
            (BEYOND, np.inf),
            largest,
            why=DRAG,
        ),
        Row(
            "case 3b: distance that the whirl keeps, last quarter [um]",
            RADIUS,
            float(np.median(radius[late])),
            near=0.15,
            why=DRAG,
        ),
    ]


NODES = {"touchdown bearing, NDE": ("A", 2), "touchdown bearing, DE": ("B", 25)}
MAGNETS = {"amb_A": (7, 11), "amb_B": (19, 23)}  # laminations between these nodes
UNBALANCES = (1.07, 2.78, 4.56)  # g.mm: axial disc, middle, gear
FITTED = "fitted to it"


def fig_18(drops: Drops) -> Exhibit:
    """Side view to scale, and the nodes and masses that the text states."""
    shaft = described(find_rotor("rotor_II"), SPEED, modes=5).shaft
    figure = sheet()
    drawing(figure, shaft)
    disc = max(shaft.points, key=lambda point: point.polar_inertia)
    rows = [Row(f"node of the {what}", node, shaft.node(name)) for what, (name, node) in NODES.items()]
    rows.append(Row("node of the axial magnetic bearing's disc", 4, disc.node))
    rows += [
        Row(f"node in the middle of {name}, laminations", (low, high), shaft.node(name))
        for name, (low, high) in MAGNETS.items()
    ]
    rows += [
        Row("mass [kg]", 106.0, shaft.mass, near=0.005, why=FITTED),
        Row("polar inertia [kg.m2]", 0.4, shaft.polar_inertia, near=0.005, why=FITTED),
    ]
    for printed, unbalance in zip(UNBALANCES, shaft.unbalances, strict=True):
        rows.append(
            Row(f"unbalance at node {unbalance.node} [g.mm]", printed, 1e6 * unbalance.moment, near=1e-6)
        )
    return Exhibit(figure, rows, ["lengths and diameters are fitted: the drawing's cannot be read"])


MOTOR = (323.5, 571.4)  # mm, the surrogate's middle part
ZERO = 1e-3  # of the largest stress


def fig_19(drops: Drops) -> Exhibit:
    """The rotor at rest; how far its bearings give way stands in the rows."""
    properties = described(find_rotor("rotor_II"), SPEED, modes=5)
    lying, shaft = properties.rest, properties.shaft
    assert lying is not None
    figure = sheet()
    draw_rest(figure, properties)
    stress = np.abs(lying.bending)
    largest = float(np.max(stress))
    middle = (1e3 * lying.position > MOTOR[0]) & (1e3 * lying.position < MOTOR[1])
    ends = float(max(stress[0], stress[-1])) / largest
    inside = float(np.max(stress[middle])) / largest
    sag_a, sag_b = _sag(*lying.reactions)
    length = float(shaft.positions()[-1])
    towards = shaft.centre_of_mass / length
    rows = [
        Row("bending stress at the ends", "zero", f"{ends:.1g} of the largest", holds=ends < ZERO),
        Row(
            "bending stress in the motor's part", "low", f"{inside:.2f} of the largest", holds=inside < 0.5
        ),
        Row(
            "centre of mass",
            "on the NDE side",
            f"at {towards:.2f} of the length from the NDE",
            holds=towards < 0.5,
            why="of the surrogate, whose lengths are fitted" if towards >= 0.5 else "",
        ),
        Row(
            "bearings' nodes give way",
            "not equally",
            f"NDE {sag_a:.2f}, DE {sag_b:.2f} um on the housings' springs",
            holds=abs(sag_a - sag_b) > 0.1 * max(sag_a, sag_b),
        ),
        Row("largest bending stress [MPa]", None, 1e-6 * largest),
    ]
    return Exhibit(figure, rows, ["the picture holds the seats rigidly; lengths and diameters are fitted"])


def _sag(load_a: float, load_b: float) -> tuple[float, float]:
    """How far the housings' springs give way under loads (N) at both ends (um)."""
    with opened(load_scene("rotor2-case1"), in_process=True) as system:
        a, b = (system.value(f"housing_{seat}.stiffness") for seat in "AB")
    return 1e6 * load_a / a, 1e6 * load_b / b


FIRST_HALF = (1, 13)  # nodes of the non-drive end's half
ONE_DROP = "one phase of the unbalance; Table 4 has the medians"


def fig_20(drops: Drops) -> Exhibit:
    """Stresses along the rotor at the instants of Table 4, one drop of each case."""
    late = [case for case in CASES if not READINGS[case][0].first]
    endings: dict[str, FinalState] = {
        case: final_state_at_first_peak(as_read(case).set(SHORT)) for case in CASES if case not in late
    }
    endings |= {
        case: run.ending for case, run in zip(late, drops.of(list(map(as_read, late))), strict=True)
    }
    figure = sheet(13.0, 3.4 * len(CASES))
    grid = figure.subplots(len(CASES), len(KINDS), sharex=True)
    for case, row in zip(CASES, grid, strict=True):
        for kind, axes in zip(KINDS, row, strict=True):
            draw_along(axes, endings[case].components["rotor"], kind, kept=True)
            axes.set_title(f"case {case}: {kind}")
    return Exhibit(
        figure, [_where(case, endings[case]) for case in CASES] + _grows(endings), [*notes(), ONE_DROP]
    )


def _where(case: str, state: FinalState) -> Row:
    """At which node the vertical bending stress is largest."""
    nodes, values = along(state.components["rotor"], "bending_y")
    node = nodes[int(np.argmax(np.abs(values)))]
    return Row(
        f"case {case}: node of the largest vertical bending stress",
        FIRST_HALF,
        node,
        why='"at the NDE side, near where the lamination ends"',
    )


def _grows(endings: Mapping[str, FinalState]) -> list[Row]:
    """Stress by case: the source's grows from 2 to 3b."""
    own = [_largest(endings[case], "bending_y") for case in CASES]
    return [
        Row(
            f"case {case}: largest vertical bending stress [MPa]",
            SOURCE[case][0],
            value,
            near=0.5,
            why=ONE_DROP,
        )
        for case, value in zip(CASES, own, strict=True)
    ]


def _largest(state: FinalState, variable: str) -> float:
    return MPA * float(np.max(np.abs(along(state.components["rotor"], variable)[1])))


MEASURED = ((661.0, 670.0), (1096.0, 1130.0), (2406.0, 2427.0), (2857.0, 2895.0))  # Hz, two planes
RIGID = 2


def table_2(drops: Drops) -> Exhibit:
    """The surrogate's, beside the source's simulated and measured ones."""
    properties = described(find_rotor("rotor_II"), SPEED, modes=RIGID + len(BENDING))
    ours = [float(value) for value in properties.frequencies[RIGID:]]
    figure = sheet()
    modes(figure, properties)
    rows = [
        Row(f"bending mode {k + 1}, simulated [Hz]", source, ours[k], near=0.005, why="fitted to it")
        for k, source in enumerate(BENDING)
    ]
    rows += [
        Row(
            f"bending mode {k + 1}, measured [Hz]",
            measured,
            ours[k],
            why="the source's own model differs as much: it is symmetric, the rotor is not quite",
        )
        for k, measured in enumerate(MEASURED)
    ]
    return Exhibit(figure, rows)


PLACES = {"A": "6014, NDE", "B": "7914, DE"}
QUANTITIES = (  # title, variable with {} for the seat, units of the table's in one of it, values at A and B
    ("bearings side by side", "bearing_{}.balls.rows", 1.0, (1.0, 2.0)),
    ("number of balls", "bearing_{}.balls.count", 1.0, (11.0, 11.0)),
    ("pitch diameter [mm]", "bearing_{}.balls.pitch_diameter", 1e3, (90.0, 85.0)),
    ("ball diameter [mm]", "bearing_{}.balls.diameter", 1e3, (12.0, 11.7)),
    ("diametral clearance of the balls [um]", "bearing_{}.balls.play", 2e6, (15.0, 9.0)),
    ("radial conformity ratio", "bearing_{}.balls.conformity", 1.0, (1.04, 1.04)),
    ("static load rating of a bearing [N]", "bearing_{}.rolling.static_rating", 1.0, (31000.0, 20900.0)),
    ("damping of the bearings together [N.s/m]", "bearing_{}.damping", 1.0, (300.0, 2.0 * 270.0)),
    ("housing's damping [N.s/m]", "housing_{}.damping", 1.0, (8418.0, 7755.0)),
    ("housing's stiffness [N/m]", "housing_{}.stiffness", 1.0, (67e6, 37e6)),
    ("housing's mass [kg]", "housing_{}.mass", 1.0, (6.61, 10.16)),
    ("clearance of the rotor [mm]", "bearing_{}.clearance", 1e3, (0.25, 0.25)),
)
SAME = 1e-6


def table_3(drops: Drops) -> Exhibit:
    """The scene's bearings and housings beside the printed table."""
    rows: list[Row] = []
    with opened(load_scene("rotor2-case1"), in_process=True) as system:
        for k, (seat, place) in enumerate(PLACES.items()):
            for title, variable, factor, printed in QUANTITIES:
                ours = factor * system.value(variable.format(seat))
                rows.append(Row(f"{place}: {title}", printed[k], ours, near=SAME))
    return Exhibit(None, rows)


NEAR = 0.5  # of the source's value
WHIRL_STRESS = "how a whirl's stress lies in the planes is the instant's; in 3b the drag decides how much"
WHOLE = "the later and larger peak, with all modes, friction and offsets as printed"


def table_4(drops: Drops) -> Exhibit:
    """Medians over phases as the source reads each case; then what is largest in the drops as printed."""
    figures = _as_read(drops)
    rows: list[Row] = []
    for case in CASES:
        for header, source, ours in zip(HEADERS, SOURCE[case][:4], medians(figures[case]), strict=True):
            rows.append(
                Row(
                    f"case {case}: {header} [MPa]",
                    source,
                    ours,
                    NEAR,
                    why=WHIRL_STRESS if WHIRLING[case] else "",
                )
            )
    for case in CASES:
        runs = drops.of(at_phases(as_printed(case)))
        largest = median(numbers([run.summary for run in runs], COLUMNS[0]))
        rows.append(Row(f"case {case} as printed: {HEADERS[0]} [MPa]", SOURCE[case][0], largest, why=WHOLE))
        rows.append(reading_row(case, drops.of(at_phases(as_read(case)))))
    return Exhibit(None, rows, [*notes(), f"medians over {PHASES} phases of the unbalance"])


def _as_read(drops: Drops) -> dict[str, Sequence[Figures]]:
    """Of each case the figures of its drops: at the first distinct peak, or at the largest."""
    first = [case for case in CASES if READINGS[case][0].first]
    drops.progress.planned(len(first) * PHASES)
    ensemble = Ensemble(PHASES, drops.folder, drops.jobs, drops.progress.done)
    figures: dict[str, Sequence[Figures]] = dict(
        zip(first, ensemble.to_first_peak([(as_read(case), WAIT) for case in first]), strict=True)
    )
    for case in CASES:
        if case not in first:
            figures[case] = [run.summary for run in drops.of(at_phases(as_read(case)))]
    return figures
