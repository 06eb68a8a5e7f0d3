"""Native FMUs of FMI 3.0: the same models behind another side in C, with arrays."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from places import ROOT
from systems import recorded

from touchdown.command.cli import main
from touchdown.fmus.description.described_variables import arrays, element
from touchdown.fmus.native.compiler import TARGETS, host_target, places_3
from touchdown.fmus.native.interfaces import FMI_3
from touchdown.fmus.native.native_build import Native as Choice
from touchdown.fmus.native.native_build import build_native
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.common.errors import FAILED
from touchdown.master.interop.check import check_fmu
from touchdown.modelkit.model import slots

Made = Callable[[str], Path]
STEP = 2e-5  # s
DROP = """
title = "Rotor I drops onto bushings"
attach = [["one.journal", "rotor.A"], ["two.journal", "rotor.B"]]
[run]
duration = "8 ms"
macro_step = "40 us"
[components.rotor]
fmu = "{folder}rotor_I{end}"
[components.one]
fmu = "{folder}bushing{end}"
[components.two]
fmu = "{folder}bushing{end}"
"""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(host_target() is None, reason="native FMUs are not built for this machine"),
]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """The FMU of a model, by name."""
    target, folder = host_target(), tmp_path_factory.mktemp("fmi3")
    assert target is not None
    return cache(lambda name: build_native(recipe(name), folder, Choice((target,), face=FMI_3)))


@pytest.fixture
def bushing(made: Made, tmp_path: Path) -> Iterator[tuple[FMU3Slave, dict[str, Any], list[str]]]:
    """An instance that is not initialised, its variables by name, and what it logs."""
    folder = extract(str(made("bushing")), str(tmp_path / "bushing"))
    description = read_model_description(folder)
    said: list[str] = []
    fmu = FMU3Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="bushing",
    )
    fmu.instantiate(loggingOn=True, logMessage=lambda *words: said.append(words[-1].decode()))
    yield fmu, {v.name: v for v in description.modelVariables}, said
    fmu.freeInstance()
    shutil.rmtree(folder)


@pytest.mark.parametrize("fmu", ["housing", "bushing"])
def test_it_is_valid_and_meets_the_model(fmu: str, made: Made):
    assert validate_fmu(str(made(fmu))) == []
    report = check_fmu(str(made(fmu)))
    assert report.problems == []
    assert "valid FMI 3.0 for co-simulation" in report.lines
    assert any("equal the installed model's" in line for line in report.lines)


@pytest.mark.parametrize("fmu", fmu_names())
def test_arrays_hold_every_variable_of_fmi_2_once(fmu: str):
    """Under the names that the master reads them by, each in its own word, alike but for their starts."""
    model = recipe(fmu).model
    read: list[tuple[str, int]] = []
    for array in arrays(model):
        indices = [()] if array.dimension is None else [(k + 1,) for k in range(array.dimension)]
        places = [array.first.index + k * array.stride for k in range(len(indices))]
        read += [(element(array.name, index), at) for index, at in zip(indices, places, strict=True)]
        assert {(s.causality, s.variable.spec) for s in array.elements} == {
            (array.first.causality, array.first.variable.spec)
        }
    assert sorted(read) == sorted((s.variable.name, s.index) for s in slots(model))


def test_a_drop_is_recorded_as_in_process(made: Made, tmp_path: Path):
    """Elastic modes cross in arrays; every number recorded is the same 64-bit word."""
    folder = made("bushing").parent
    assert folder == made("rotor_I").parent
    found = {}
    for name, text in (
        ("third", DROP.format(folder=f"{folder}/", end=".fmu")),
        ("within", DROP.format(folder="", end="")),
    ):
        scene = tmp_path / f"{name}.toml"
        scene.write_text(text)
        ways = ["--in-process"] if name == "within" else []
        assert main(["run", str(scene), *ways, "--quiet", "--no-pictures", "-o", str(tmp_path / name)]) == 0
        found[name] = recorded(tmp_path / name)
    assert found["within"]["one/contact.force"].max() > 100.0  # N: they hit
    assert found["third"].keys() == found["within"].keys()
    assert {n for n, v in found["within"].items() if v.tobytes() != found["third"][n].tobytes()} == set()


def test_arrays_are_set_and_read_whole_and_between_scalars(bushing: Any):
    fmu, variables, _ = bushing
    x, vy, clearance = (
        variables[n].valueReference for n in ("journal.mode.x", "journal.mode.vy", "clearance")
    )
    given = [*np.arange(1.0, 21.0) * 1e-9, 4e-4, *np.arange(20) * -1e-6]
    fmu.setFloat64([x, clearance, vy], given)
    assert fmu.getFloat64([x, clearance, vy], nValues=41) == given
    assert fmu.getFloat64([vy, x], nValues=40) == [*given[21:], *given[:20]]


def test_elements_and_other_types_are_refused_by_name(bushing: Any):
    fmu, variables, said = bushing
    modes = next(a for a in arrays(recipe("bushing").model) if a.name == "journal.mode.x")
    second, law = modes.first.index + modes.stride, variables["friction.kind"].valueReference
    for refused in (
        lambda: fmu.setFloat64([second], [0.0]),
        lambda: fmu.setFloat64([law], [1.0]),
        lambda: fmu.setInt32([law], [1]),
        lambda: fmu.getBoolean([modes.first.index]),
    ):
        with pytest.raises(Exception, match="failed with status 3"):
            refused()
    assert f"value reference {second} cannot be set as Float64 now" in said[0]
    assert "friction.kind cannot be set as Float64 now" in said[1]
    assert "friction.kind cannot be set as Int32 now" in said[2]
    assert "journal.mode.x cannot be read as Boolean" in said[3]


def test_a_step_that_is_discarded_leaves_no_trace(bushing: Any):
    """A smaller one can be taken, with the numbers of an instance that was never asked for the larger."""
    fmu, variables, said = bushing
    force = [variables["journal.fy"].valueReference]
    given = {"journal.y": -0.305e-3, "journal.vy": -0.4, "interface.tolerance": 1e-14}
    answers = []
    for tried in (False, True):
        fmu.reset()
        fmu.setFloat64([variables[n].valueReference for n in given], list(given.values()))
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        if tried:
            with pytest.raises(Exception, match="status 2"):
                fmu.doStep(0.0, 100.0)
            assert "take a smaller macro step" in said[-1]
        fmu.doStep(0.0, STEP)
        answers.append(fmu.getFloat64(force))
    assert answers[0] == answers[1]
    assert answers[0][0] > 0.0


def test_states_are_kept_and_written_down(bushing: Any):
    fmu, variables, _ = bushing
    force = [variables["journal.fy"].valueReference]
    fmu.setFloat64([variables["journal.y"].valueReference], [-0.32e-3])
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    kept = fmu.getFMUState()
    fmu.doStep(0.0, STEP)
    once = fmu.getFloat64(force)
    assert once[0] > 0.0
    written = fmu.serializeFMUState(kept)
    fmu.setFMUState(kept)
    fmu.doStep(0.0, STEP)
    assert fmu.getFloat64(force) == once
    fmu.setFMUState(fmu.deserializeFMUState(written))
    fmu.doStep(0.0, STEP)
    assert fmu.getFloat64(force) == once


def test_binaries_lie_where_fmi_3_looks():
    told = places_3(
        tuple(TARGETS[n] for n in ("linux-x86_64-v2", "linux-aarch64", "windows-x86_64", "macos-arm64"))
    )
    assert list(told) == ["x86_64-linux", "aarch64-linux", "x86_64-windows", "aarch64-darwin"]


def test_a_name_that_fmi_3_has_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """And groups of a model's own, which the contract does not have several of, stay scalars."""
    for name in ("rubber_ring.py", "rubber_ring.c"):
        text = (ROOT / "examples" / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text.replace("m->p.damping", "m->p.time").replace("damping:", "time:"))
    command = ["build", "--native", str(tmp_path / "rubber_ring.py"), "-o", str(tmp_path)]
    assert main([*command, "--fmi", "3"]) == FAILED
    assert "rubber_ring has a variable called time" in capsys.readouterr().err
    assert main(command) == 0


def test_pythonfmus_fmus_are_of_fmi_2(capsys: pytest.CaptureFixture[str]):
    assert main(["build", "housing", "--fmi", "3"]) == FAILED
    assert "add --native" in capsys.readouterr().err
