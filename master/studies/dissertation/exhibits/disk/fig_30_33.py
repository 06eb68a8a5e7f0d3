"""Figs 30 to 33: contact forces in the four models."""

from __future__ import annotations

import numpy as np

from touchdown.master.results.figures.forces import forces
from touchdown.master.results.figures.style import sheet
from touchdown.master.results.result import Result
from touchdown.master.studies.dissertation.exhibits.disk.pair import (
    CAGED,
    CAGELESS,
    NEAR_HZ,
    SWINGS,
    column,
    ending_part,
    pair,
)
from touchdown.master.studies.dissertation.exhibits.drops import Drops, figure_of, finished, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

FIRST = 5e-3  # s after the first touch: the first contact is over
NEVER = "never"
BALL = "first_impact_ball_force_N"


def fig_30(drops: Drops) -> Exhibit:
    """Simplified, with a cage."""
    return _exhibit(drops, CAGED, "simplified")


def fig_31(drops: Drops) -> Exhibit:
    """Detailed, with a cage."""
    exhibit = _exhibit(drops, CAGED, "detailed")
    run = _run(drops, CAGED, "detailed")
    knocks = _share(run, "pockets.force")
    regular = Row("balls on the cage in the last 50 ms", "all the time", knocks, holds=knocks != NEVER)
    return exhibit._replace(rows=[*exhibit.rows, regular])


def fig_32(drops: Drops) -> Exhibit:
    """Simplified, without a cage."""
    return _exhibit(drops, CAGELESS, "simplified")


def fig_33(drops: Drops) -> Exhibit:
    """Detailed, without a cage."""
    exhibit = _exhibit(drops, CAGELESS, "detailed")
    touches = _share(_run(drops, CAGELESS, "detailed"), "neighbours.force")
    none = Row(
        "balls on each other in the last 50 ms",
        NEVER,
        touches,
        holds=touches == NEVER,
        why="where the balls come to lie is chaotic" if touches != NEVER else "",
    )
    return exhibit._replace(rows=[*exhibit.rows, none])


def _run(drops: Drops, cage: str, kind: str) -> Result:
    return getattr(pair(drops, cage), kind)


def _exhibit(drops: Drops, cage: str, kind: str) -> Exhibit:
    run = _run(drops, cage, kind)
    figure = sheet()
    forces(figure, finished(run), seats_of(run)[0])
    return Exhibit(figure, [*_rows(run), _ratio(drops, kind)])


def _rows(run: Result) -> list[Row]:
    force, time = column(run, "contact.force"), run.recording.time
    first = figure_of(run, "first_contact_time_s") or 0.0
    at = float(time[np.argmax(force)])
    pendulum = figure_of(run, "pendulum_frequency_Hz")
    swing = None if pendulum is None else 0.5 / pendulum
    return [
        Row(
            "rotor on ring, when the force is largest",
            "first contact",
            f"{1e3 * (at - first):.2f} ms after it",
            holds=at - first < FIRST,
        ),
        Row("rotor on ring, largest force [N]", None, figure_of(run, "peak_contact_force_N")),
        Row("worst ball in the first contact [N]", None, figure_of(run, BALL)),
        Row("one swing of the pendulum [s]", 0.018, swing, NEAR_HZ, why=SWINGS),
    ]


def _ratio(drops: Drops, kind: str) -> Row:
    """How much harder the first contact presses a ball in the caged bearing."""
    caged, cageless = (figure_of(_run(drops, cage, kind), BALL) for cage in (CAGED, CAGELESS))
    ours = caged / cageless if caged and cageless else None
    return Row(f"{kind}: worst ball in the first contact, caged over cageless [1]", 2.0, ours, near=0.15)


def _share(run: Result, variable: str) -> str:
    """How often something presses in the last 50 ms."""
    force = column(run, variable)[ending_part(run)]
    return f"{100.0 * np.mean(force > 0.0):.0f} % of the time" if np.any(force > 0.0) else NEVER
