"""Rotors imported by the command and in Python: `touchdown import rotor`, `touchdown.import_rotor`."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import ROOT

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED, TouchdownError

PUMP = str(ROOT / "examples" / "pump_sections.csv")
SAVED = ROOT / "validation" / "ross"


def test_a_table_becomes_a_rotor_with_its_places(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "deep" / "pump.toml"
    places = ["--at", "A=50 mm,B=17", "--amb", "amb_A=7", "--amb", "amb_B=15", "--sensors", "eye=8"]
    assert main(["import", "rotor", PUMP, "-o", str(path), *places]) == 0
    told = capsys.readouterr().out
    assert "stations: A at node 4, B at node 18, amb_A at node 8, amb_B at node 16" in told
    assert f"touchdown rotor {path}" in told
    rotor = touchdown.Rotor.load(path)
    amb = {"amb_A": 7, "amb_B": 15}
    assert rotor == touchdown.import_rotor(PUMP, {"A": "50 mm", "B": 17}, amb, {"eye": 8})
    assert rotor.levitated_at == ("amb_A", "amb_B")


def test_a_rotor_of_ross_says_what_is_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    rotor = touchdown.import_rotor(SAVED / "compressor_example.toml", speed=628.3)
    assert "12 seals are left out." in rotor.about
    assert len(rotor.supports) == 2
    assert rotor.frequencies(3)[2] == pytest.approx(154.83, abs=0.01)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ((PUMP, "--at", "A"), "--at A: write NAME=VALUE"),
        ((PUMP, "--at", "A=1,A=2"), "--at A=2: A is there twice"),
        ((PUMP, "--at", "A=1 m"), "1000 mm is not on the rotor pump_sections, which ends at 520 mm"),
        ((PUMP, "--at", "stress=1"), "has a name that cannot be used"),
        (("gone.csv",), "cannot read gone.csv"),
        ((PUMP, "--speed", "fast"), "--speed = 'fast' is not a number"),
    ],
)
def test_mistakes_are_told_in_one_line(
    options: tuple[str, ...], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["import", "rotor", *options, "-o", "never.toml"]) == FAILED
    told = capsys.readouterr().err.strip()
    assert says in told
    assert "\n" not in told
    assert not Path("never.toml").exists()


def test_what_is_no_rotor_is_told_in_python() -> None:
    with pytest.raises(TouchdownError, match="a int is no"):
        touchdown.import_rotor(3)
