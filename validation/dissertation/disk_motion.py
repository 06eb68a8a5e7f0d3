"""Section 4.3, figures of motion: Figs 22 to 26."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from ...bearings.contact.friction import FrictionLaw, coefficient, derive
from ...master.coupling.connections import Attachment, housing_port
from ...master.results.final_state import Finished
from ...master.results.result import Result
from ...master.scene.file import load_scene
from ...modelkit.variables import as_record
from ...reports.figures import style
from ...reports.figures.motion import paths
from ...reports.figures.style import BLUE, GREY, ORANGE, Curve, sheet
from ..case import Found, Row
from .drop_cache import Drops, figure_of, finished, seats_of

CAGELESS, CAGED = "cageless", "caged"
SWINGS = "28 Hz is that of small swings: the wider a pendulum swings, the slower"
NEAR_HZ = 1.0 / 28.0  # 1 Hz of the pendulum's 28
LAST = 0.05  # s, the dissertation's closest view of the end
Span = tuple[float, float]


class _Pair(NamedTuple):
    """Both models' drops of the same bearing."""

    detailed: Result
    simplified: Result


def pair(drops: Drops, cage: str) -> _Pair:
    """The drops on a bearing, CAGED or CAGELESS."""
    return _Pair(*drops.of([load_scene(f"disk-{cage}-{kind}") for kind in _Pair._fields]))


def each(runs: _Pair) -> list[tuple[str, Result]]:
    """The models' names and runs."""
    return list(zip(_Pair._fields, runs, strict=True))


def column(run: Result, variable: str) -> np.ndarray:
    """Recorded values of a variable of its bearing."""
    return run.recording[f"{seats_of(run)[0].bearing}.{variable}"]


def ending_part(run: Result) -> np.ndarray:
    """Which recorded values are of the last 50 ms."""
    time = run.recording.time
    return time >= time[-1] - LAST


def stacked(
    runs: _Pair, draw: Callable[[FigureBase, Finished, Attachment], object], width: float, heights: Span
) -> Figure:
    """A figure with the picture of the detailed model above that of the simplified one; inch."""
    figure = sheet(width, sum(heights))
    parts = figure.subfigures(2, 1, squeeze=False, height_ratios=heights).flat
    for part, run in zip(parts, runs, strict=True):
        draw(part, finished(run), seats_of(run)[0])
    return figure


CIRCUMFERENTIAL_SPEEDS = (  # in the order they are drawn: what varies most first
    Curve("hardest.speed", "hardest-hit ball, spin", GREY),
    Curve("speed.cage", "cage", BLUE),
    Curve("speed.orbit", "balls, mean orbit", style.GREEN, 1.8),  # often hidden by the next
    Curve("speed.ball", "balls, mean spin", style.PURPLE),
    Curve("speed.ring", "inner race / 2", ORANGE),
    Curve("speed.rotor", "rotor / 2, at the race", style.BLACK),
)


def _circumferential(
    figure: FigureBase, run: Finished, a: Attachment, spans: tuple[Span, ...], once_spun_up: Span
) -> list[Axes]:
    """Speeds of all bodies [m/s] over the `spans` (s), the second one between Halminen's limits (m/s)."""
    time = run.recording.time
    row = list(figure.subplots(1, len(spans)))
    for axes, span in zip(row, spans, strict=True):
        part = style.within(time, span)
        for c in style.present(run.recording, a.bearing, CIRCUMFERENTIAL_SPEEDS):
            values = run.recording[f"{a.bearing}.{c.variable}"][part]
            axes.plot(*style.thinned(time[part], values), color=c.colour, lw=c.width, label=c.label)
        axes.set_xlim(*span)
        axes.set_xlabel(style.TIME)
        axes.ticklabel_format(useOffset=False)
    row[0].set_ylabel("circumferential speed [m/s]")
    low, high = once_spun_up
    row[1].set_title(f"the dissertation's view: {low:g} to {high:g} m/s")
    for limit in once_spun_up:
        row[1].axhline(limit, color=GREY, ls="--", lw=0.8)
    row[1].set_ylim(low - 0.05 * (high - low), high + 0.2 * (high - low))
    handles, labels = row[0].get_legend_handles_labels()
    figure.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=len(labels))
    figure.suptitle(run.scene.title)
    return row


CONTACTS = (  # as the dissertation colours them, with its static and its sliding coefficient
    ("balls, balls and cage", BLUE, 0.03, 0.02),
    ("balls and rings, rotor and ring", ORANGE, 0.15, 0.10),
)
SLIDING_SPEEDS = np.linspace(-1.0, 1.0, 1601)  # m/s
PLATEAU = 1.0  # m/s, where what rises is done
VISCOUS = "the viscous term of 1e-4 s/m, at 1 m/s"


def fig_22(drops: Drops) -> Found:
    """Both curves; g1 is found from the peak, the other constants but g4 are assumed (g2, g3, g5)."""
    figure = sheet(9.0, 5.0)
    axes = figure.subplots()
    rows: list[Row] = []
    for name, colour, static, sliding in CONTACTS:
        law = np.array([as_record(FrictionLaw(static=static, dynamic=sliding))]).view(np.recarray)[0]
        derive(law)
        curve = np.array([coefficient(speed, law) for speed in SLIDING_SPEEDS])
        axes.plot(SLIDING_SPEEDS, curve, color=colour, lw=1.6, label=name)
        axes.axhline(static, color=GREY, lw=0.8, ls="--")
        axes.axhline(sliding, color=GREY, lw=0.8, ls=":")
        rows += [
            Row(f"{name}: static, the peak", "", static, float(np.max(curve)), 0.001),
            Row(f"{name}: sliding", "", sliding, coefficient(PLATEAU, law), 0.01, VISCOUS),
        ]
    axes.set_xlabel("sliding speed [m/s]")
    axes.set_ylabel("friction coefficient [1]")
    axes.set_title(
        "friction of section 4.3; dashed and dotted: the dissertation's static and sliding coefficients"
    )
    axes.legend(loc="lower right")
    notes = ["slopes g2 = g5 = 100 s/m and g3 = 10 s/m are assumed, g1 follows from the peak"]
    return Found(rows, figure, notes)


RINGS = "both rings pressed together through a ball"
RATTLE = "undamped balls and cage that rattle: chaotic; where the lowest ball sits"


def fig_23(drops: Drops) -> Found:
    """Rotor and rings of the bearing without a cage."""
    runs = pair(drops, CAGELESS)
    rows = [Row(f"{name}: {RINGS}", "um", (0.0, 6.0), _together(run)) for name, run in each(runs)]
    return Found([*rows, *_pendulum(runs)], stacked(runs, paths, 15.6, (5.4, 5.4)))


def fig_24(drops: Drops) -> Found:
    """Rotor, rings and cage of the caged bearing."""
    runs = pair(drops, CAGED)
    rows = [Row(f"{name}: {RINGS}", "um", 8.0, _together(run), 0.1, RATTLE) for name, run in each(runs)]
    cage = _cage(runs.detailed)
    rows.append(Row("detailed: cage, farthest from its middle", "um", 20.0, cage, 0.3, RATTLE))
    return Found([*rows, *_pendulum(runs)], stacked(runs, paths, 15.6, (11.0, 5.4)))


def _together(run: Result) -> float | None:
    """How far the rings are pressed together at most (um), the two indentations of a ball added up."""
    whole = figure_of(run, "peak_indentation_rings")
    if whole is not None:
        return whole
    parts = [figure_of(run, f"peak_indentation_ball_{race}") for race in ("inner", "outer")]
    return sum(part for part in parts if part is not None)


def _cage(run: Result) -> float:
    """Largest distance of the cage from the middle of the housing at rest (um)."""
    port = housing_port(run.ending, seats_of(run)[0].bearing)
    x, y = (column(run, f"cage.{axis}") - run.recording[f"{port}.{axis}"][0] for axis in "xy")
    return 1e6 * float(np.max(np.hypot(x, y)))


def _pendulum(runs: _Pair) -> list[Row]:
    key = "pendulum_frequency"
    return [
        Row(f"{name}: pendulum", "Hz", 28.0, figure_of(run, key), NEAR_HZ, SWINGS)
        for name, run in each(runs)
    ]


BODIES = ("speed.rotor", "speed.ring", "speed.ball", "speed.orbit", "speed.cage", "hardest.speed")
NEAR_SYNC = 0.5  # "circa 0.1 s"
RINGS_SWING = "the ring swings with the pendulum; how fast that dies away depends on the damping"
RUN_DOWN = (
    "the dissertation's rotor has slowed to 8450 rpm (Fig 28), which takes a drag that it does not state"
)
MOMENT = "damping and friction law of the simplified model's rolling moment"


def fig_25(drops: Drops) -> Found:
    """The bearing without a cage: (b) shows 5.1 to 5.57 m/s, (c) a height of 0.065 m/s."""
    return _speeds(pair(drops, CAGELESS), 0.15, (5.1, 5.57), 0.065)


def fig_26(drops: Drops) -> Found:
    """The caged bearing: (b) shows 5.1 to 5.7 m/s, (c) a height of 0.05 m/s."""
    runs = pair(drops, CAGED)
    found = _speeds(runs, 0.2, (5.1, 5.7), 0.05)
    detailed, simplified = (float(np.ptp(column(run, "speed.ring")[ending_part(run)])) for run in runs)
    smaller = simplified < detailed
    theirs, ours = (
        "smaller in the simplified model",
        f"detailed {detailed:.2g}, simplified {simplified:.2g} m/s",
    )
    swing = "swing of the ring's speed in the last 50 ms"
    row = Row(swing, "", theirs, ours, why="" if smaller else MOMENT, holds=smaller)
    return found._replace(rows=[*found.rows, row])


def _speeds(runs: _Pair, spin_up: float, limits: Span, height: float) -> Found:
    """Halminen's three views, the spin-up (s), all, and the end, and what it tells of them (m/s)."""
    spans = (0.0, spin_up), (0.0, 5.0), (5.0 - LAST, 5.0)
    figure = stacked(runs, partial(_circumferential, spans=spans, once_spun_up=limits), 17.5, (5.2, 5.2))
    rows: list[Row] = []
    for name, run in each(runs):
        pendulum, sync = (figure_of(run, key) for key in ("pendulum_frequency", "ring_sync_time"))
        time, period = run.recording.time, None if pendulum is None else 1.0 / pendulum
        ring = column(run, "speed.ring")[time >= (time[-1] if sync is None else sync)]  # once spun up
        ring_range = float(np.min(ring)), float(np.max(ring))
        bodies = [body for body in BODIES if f"bearing.{body}" in run.recording]
        spread = float(np.ptp(np.concatenate([column(run, body)[ending_part(run)] for body in bodies])))
        why = RUN_DOWN if ring_range[1] > limits[1] else ""
        rows += [
            Row(f"{name}: ring reaches the rotor's speed", "s", 0.1, sync, NEAR_SYNC),
            Row(f"{name}: half the inner race's speed, once spun up", "m/s", limits, ring_range, why=why),
            Row(
                f"{name}: range of all speeds in the last 50 ms",
                "m/s",
                (0.0, height),
                spread,
                why=RINGS_SWING,
            ),
            Row(f"{name}: pendulum, to and fro", "s", 0.036, period, NEAR_HZ, SWINGS),
        ]
    return Found(rows, figure)
