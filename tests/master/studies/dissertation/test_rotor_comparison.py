"""The tables that set the rotors beside the source."""

from __future__ import annotations

from touchdown.master.studies.dissertation.whirling_drops import numbers, phases, spread


def test_the_ensemble_is_spread_around_the_circle() -> None:
    assert phases(4) == {"rotor.unbalance_angle": ["0 deg", "90 deg", "180 deg", "270 deg"]}


def test_a_figure_that_no_drop_has_is_a_dash() -> None:
    drops = [{"turns": 1.0}, {"turns": 3.0}, {"turns": 8.0}, {"turns": None}, {}]
    assert spread(numbers(drops, "turns")) == "3 (1 to 8)"
    assert spread(numbers(drops, "peak")) == "-"
