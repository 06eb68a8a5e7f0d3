"""Figs 23 and 24: where the rotor, the rings and the cage go."""

from __future__ import annotations

import numpy as np

from touchdown.master.results.ending import housing_port
from touchdown.master.results.figures.motion import paths
from touchdown.master.results.result import Result
from touchdown.master.studies.dissertation.exhibits.disk.pair import (
    CAGED,
    CAGELESS,
    NEAR_HZ,
    SWINGS,
    column,
    pair,
    stacked,
)
from touchdown.master.studies.dissertation.exhibits.drops import Drops, figure_of, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

RINGS = "both rings pressed together through a ball [um]"
RATTLE = "undamped balls and cage that rattle: chaotic; where the lowest ball sits"


def fig_23(drops: Drops) -> Exhibit:
    """Rotor and rings of the bearing without a cage."""
    runs = pair(drops, CAGELESS)
    rows = [
        Row(f"{name}: {RINGS}", (0.0, 6.0), _together(run))
        for name, run in zip(runs._fields, runs, strict=True)
    ]
    return Exhibit(stacked(runs, paths, 15.6, (5.4, 5.4)), [*rows, *_pendulum(runs)])


def fig_24(drops: Drops) -> Exhibit:
    """Rotor, rings and cage of the caged bearing."""
    runs = pair(drops, CAGED)
    rows = [
        Row(f"{name}: {RINGS}", 8.0, _together(run), near=0.1, why=RATTLE)
        for name, run in zip(runs._fields, runs, strict=True)
    ]
    cage = Row(
        "detailed: cage, farthest from its middle [um]", 20.0, _cage(runs.detailed), near=0.3, why=RATTLE
    )
    return Exhibit(stacked(runs, paths, 15.6, (11.0, 5.4)), [*rows, cage, *_pendulum(runs)])


def _together(run: Result) -> float | None:
    """How far the rings are pressed together at most (um), the two indentations of a ball added up."""
    whole = figure_of(run, "peak_indentation_rings_um")
    if whole is not None:
        return whole
    parts = [figure_of(run, f"peak_indentation_ball_{race}_um") for race in ("inner", "outer")]
    return sum(part for part in parts if part is not None)


def _cage(run: Result) -> float:
    """Largest distance of the cage from the middle of the housing at rest (um)."""
    port = housing_port(run.ending, seats_of(run)[0])
    rest = [run.recording[f"{port}.{axis}"][0] for axis in "xy"]
    x, y = (column(run, f"cage.{axis}") - at for axis, at in zip("xy", rest, strict=True))
    return 1e6 * float(np.max(np.hypot(x, y)))


def _pendulum(runs: tuple[Result, Result]) -> list[Row]:
    names = ("detailed", "simplified")
    return [
        Row(f"{name}: pendulum [Hz]", 28.0, figure_of(run, "pendulum_frequency_Hz"), NEAR_HZ, why=SWINGS)
        for name, run in zip(names, runs, strict=True)
    ]
