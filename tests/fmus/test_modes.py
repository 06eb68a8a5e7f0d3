"""FMUs for some number of modes: what they start from, what their seats tell of, and what stays."""

from __future__ import annotations

from pathlib import Path

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu

from touchdown.command.cli import main
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.fmus.variants import modes_listed
from touchdown.master.common.errors import FAILED
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model, slots
from touchdown.rotor.file import shipped_rotors

MOST = 56  # connectors of a bearing without modes
STEP = 2e-5  # s


def connectors(model: Model) -> list[str]:
    """Names of inputs and outputs that are connected."""
    crossing = (s for s in slots(model) if s.causality != "parameter" and not s.variable.spec.local)
    return [s.variable.name for s in crossing if s.causality == "input" or not s.variable.spec.constant]


@pytest.mark.parametrize("name", [name for name in fmu_names() if "ca" in name or name == "bushing"])
def test_a_bearing_without_modes_has_few_connectors(name: str):
    assert (
        len(connectors(recipe(name).with_modes(2, 0).model)) <= MOST < len(connectors(recipe(name).model))
    )


def test_a_rotor_starts_with_them_and_its_seats_tell_of_as_many():
    for count, residual in ((2, 0), (5, 1), (12, 1)):
        model = recipe("rotor_I").with_modes(count, modes_listed(count, [recipe("rotor_I").model])).model
        starts = {s.variable.name: s.variable.default for s in slots(model)}
        assert (starts["modes"], starts["residual"]) == (count, residual)
        told = sum(name.startswith("A.mode[") and name.endswith(".inv_m") for name in starts)
        assert told == (0 if count == 2 else count)
        instance = Instance(model)
        instance.start(0.0)
        assert instance.record["d"]["slots"].max() <= told


def test_a_rotor_in_three_bearings_has_a_connector_more(tmp_path: Path):
    """One residual vector for each seat."""
    text = shipped_rotors()["rotor_I"].read_text(encoding="utf-8")
    assert "[stations]\n" in text
    (tmp_path / "three.toml").write_text(text.replace("[stations]\n", "[stations]\nC = 10\n"))
    assert main(["build", str(tmp_path / "three.toml"), "--modes", "5", "-o", str(tmp_path)]) == 0
    variables = read_model_description(str(tmp_path / "three.fmu")).modelVariables
    assert len({v.name.split("]")[0] for v in variables if v.name.startswith("C.mode[")}) == 6
    assert validate_fmu(str(tmp_path / "three.fmu")) == []


def test_numbers_stay_where_no_more_modes_are_in_use():
    """To the last bit."""
    ends = []
    for chosen in (recipe("rotor_I"), recipe("rotor_I").with_modes(5, 5)):
        instance = Instance(chosen.model)
        instance.start(0.0)
        for k in range(5):
            instance.step(k * STEP, STEP)
        ends.append(instance.memory["o"].tobytes())
    assert ends[0] == ends[1]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--modes", "1"), "give 2 (rigid) or more, or 0 for all"),
        (("--modes", "2,5"), "give the one to start with"),
        (("--modes", "41"), "rotor_I: modes = 41 must be from 2 (rigid) to 40"),
        (("--modes", "x"), "whole numbers"),
    ],
)
def test_what_cannot_be_is_named(
    arguments: tuple[str, ...], named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    assert main(["build", "rotor_I", *arguments, "-o", str(tmp_path)]) == FAILED
    said = capsys.readouterr().err
    assert named in said
    assert len(said.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
