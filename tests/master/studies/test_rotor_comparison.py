"""The tables that set the rotors beside the source."""

from __future__ import annotations

from pathlib import Path

import pytest

from touchdown.master.coupling.simulation import open_system
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation import rotors as rotor_comparison
from touchdown.master.studies.dissertation.rotors import (
    SOURCE_4,
    TABLE_4,
    Case,
    phases,
    runs,
    spread,
    verdicts,
)
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
    assert runs(4) == 4 * len(TABLE_4)


def test_a_figure_that_no_run_has_is_a_dash() -> None:
    assert (
        spread([member(1.0, 0.0), member(3.0, 0.0), member(8.0, 0.0)], "whirl_A_revolutions")
        == "3 (1 to 8)"
    )
    assert spread([member(1.0, 0.0)], "peak") == "-"


@pytest.mark.parametrize("row", TABLE_4, ids=lambda row: f"{row.case} {row.reading}")
def test_every_row_can_be_assembled(row: Case) -> None:
    """Its settings exist in its scene, and the source has its case."""
    assert row.case in SOURCE_4
    open_system(load_scene(f"rotor2-case{row.case}").set(row.settings), in_process=True).close()


def test_a_table_of_one_short_drop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Source and own stresses under each other, the verdict at the end."""
    monkeypatch.setattr(rotor_comparison, "TABLE_4", (Case("1", "short", {"run.duration": 9e-3}),))
    source, own = rotor_comparison.table_4(1, tmp_path, 1, lambda: None)
    assert source.split() == ["case", "1,", "source", "8.76", "2.28", "0.59", "0.16", "no", "whirl"]
    assert own.split()[0] == "short"
    assert 5.0 < float(own.split()[1]) < 13.0
    assert own.endswith("1 x no whirl")
