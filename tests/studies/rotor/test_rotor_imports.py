"""Rotors imported by the command and in Python: `touchdown import rotor`, `touchdown.import_rotor`."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import ROOT

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError

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
    with pytest.raises(TouchdownError, match="a int is no"):
        touchdown.import_rotor(3)
