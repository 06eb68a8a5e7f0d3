"""Figs 25 and 26: circumferential speeds of ring, balls and cage, as half of the inner race's (4.2)."""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.figure import Figure

from touchdown.master.results.result import Result
from touchdown.master.studies.dissertation.exhibits.disk.circumferential import circumferential
from touchdown.master.studies.dissertation.exhibits.disk.pair import (
    CAGED,
    CAGELESS,
    LAST,
    NEAR_HZ,
    SWINGS,
    Pair,
    column,
    ending_part,
    pair,
    stacked,
)
from touchdown.master.studies.dissertation.exhibits.drops import Drops, figure_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row, Span

BODIES = ("speed.rotor", "speed.ring", "speed.ball", "speed.orbit", "speed.cage", "hardest.speed")
NEAR_SYNC = 0.5  # "circa 0.1 s"
RINGS_SWING = "the ring swings with the pendulum; how fast that dies away hangs on the damping"
RUN_DOWN = "the source's rotor has slowed to 8450 rpm (Fig 28), which takes a drag that it does not state"


def fig_25(drops: Drops) -> Exhibit:
    """The bearing without a cage: (b) shows 5.1 to 5.57 m/s, (c) a height of 0.065 m/s."""
    runs = pair(drops, CAGELESS)
    return Exhibit(_figure(runs, 0.15, (5.1, 5.57)), _rows(runs, (5.1, 5.57), 0.065))


def fig_26(drops: Drops) -> Exhibit:
    """The caged bearing: (b) shows 5.1 to 5.7 m/s, (c) a height of 0.05 m/s."""
    runs = pair(drops, CAGED)
    rows = _rows(runs, (5.1, 5.7), 0.05)
    swings = [float(np.ptp(column(run, "speed.ring")[ending_part(run)])) for run in runs]
    smaller = swings[1] < swings[0]
    rows.append(
        Row(
            "swing of the ring's speed in the last 50 ms",
            "smaller in the simplified model",
            f"detailed {swings[0]:.2g}, simplified {swings[1]:.2g} m/s",
            holds=smaller,
            why="" if smaller else "damping and friction law of the simplified model's rolling moment",
        )
    )
    return Exhibit(_figure(runs, 0.2, (5.1, 5.7)), rows)


def _figure(runs: Pair, spin_up: float, limits: Span) -> Figure:
    """The source's three views: the spin-up (s), all, and the end."""
    spans = (0.0, spin_up), (0.0, 5.0), (5.0 - LAST, 5.0)
    return stacked(runs, partial(circumferential, spans=spans, once_spun_up=limits), 17.5, (5.2, 5.2))


def _rows(runs: Pair, range_b: Span, height_c: float) -> list[Row]:
    rows: list[Row] = []
    for name, run in zip(runs._fields, runs, strict=True):
        pendulum = figure_of(run, "pendulum_frequency_Hz")
        low, high = _ring_once_spun_up(run)
        rows += [
            Row(
                f"{name}: ring reaches the rotor's speed [s]",
                0.1,
                figure_of(run, "ring_sync_time_s"),
                near=NEAR_SYNC,
            ),
            Row(
                f"{name}: half the inner race's speed, once spun up [m/s]",
                range_b,
                (low, high),
                why=RUN_DOWN if high > range_b[1] else "",
            ),
            Row(
                f"{name}: range of all speeds in the last 50 ms [m/s]",
                (0.0, height_c),
                _spread(run),
                why=RINGS_SWING,
            ),
            Row(
                f"{name}: pendulum, to and fro [s]",
                0.036,
                None if pendulum is None else 1.0 / pendulum,
                near=NEAR_HZ,
                why=SWINGS,
            ),
        ]
    return rows


def _period(frequency: float | None) -> float | None:
    return None if frequency is None else 1.0 / frequency


def _ring_once_spun_up(run: Result) -> Span:
    """Smallest and largest speed of the ring once it first turned with the rotor (m/s)."""
    sync = figure_of(run, "ring_sync_time_s")
    after = column(run, "speed.ring")[
        run.recording.time >= (run.recording.time[-1] if sync is None else sync)
    ]
    return float(np.min(after)), float(np.max(after))


def _spread(run: Result) -> float:
    """Largest less smallest of all bodies' speeds in the last 50 ms (m/s)."""
    part = ending_part(run)
    bearing = [body for body in BODIES if _has(run, body)]
    values = np.concatenate([column(run, body)[part] for body in bearing])
    return float(np.ptp(values))


def _has(run: Result, variable: str) -> bool:
    return f"bearing.{variable}" in run.recording
