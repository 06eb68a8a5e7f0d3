"""The tables that set the rotors beside the source."""

from __future__ import annotations

from touchdown.master.studies.dissertation import table_4
from touchdown.master.studies.dissertation.ensemble import numbers, phases, spread
from touchdown.master.studies.dissertation.rotors import FIG_14, runs, verdicts
from touchdown.master.studies.sweep.report import Member


def member(turns_a: float, turns_b: float, failed: str = "") -> Member:
    """A drop whose seats whirl by so many turns."""
    summary = {"whirl_A": f"{turns_a:g} turns", "whirl_B": f"{turns_b:g} turns"}
    summary |= {"whirl_A_revolutions": turns_a, "whirl_B_revolutions": turns_b}
    return Member(1, {}, {} if failed else summary, failed)


def test_verdicts_are_those_of_the_seat_that_whirls_more() -> None:
    ensemble = [member(0.0, 3.0), member(0.0, 3.0), member(5.0, 3.0), member(0.0, 0.0, "it broke")]
    assert verdicts(ensemble) == "2 x 3 turns, 1 x 5 turns, 1 x failed: it broke"


def test_the_ensemble_is_spread_around_the_circle() -> None:
    assert phases(4) == {"rotor.unbalance_angle": ["0 deg", "90 deg", "180 deg", "270 deg"]}
    assert runs(4) == 4 * 2 * len(FIG_14) + table_4.runs(4)


def test_a_figure_that_no_drop_has_is_a_dash() -> None:
    drops = [{"turns": 1.0}, {"turns": 3.0}, {"turns": 8.0}, {"turns": None}, {}]
    assert spread(numbers(drops, "turns")) == "3 (1 to 8)"
    assert spread(numbers(drops, "peak")) == "-"
