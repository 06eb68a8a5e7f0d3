"""FMUs of the project beside their models: equal, or the first difference is told."""

from __future__ import annotations

import math
import os
import re
import signal
from collections.abc import Mapping
from pathlib import Path

import pytest
from archives import entries_of, saying

from touchdown.fmus.build import build_fmu
from touchdown.fmus.recipes import recipe
from touchdown.master.components.fmu import ArchivedFmu
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.components.loading import load_component
from touchdown.master.interop import check, twin
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.contract import CheckReport, port_sides

LINE = "50 steps of 2e-05 s: all outputs equal the installed model's to the last bit"


def compared(fmu: Path) -> CheckReport:
    """What is found of the FMU beside its model, and nothing else."""
    report, component = CheckReport(""), load_component("checked", str(fmu))
    assert isinstance(component, ArchivedFmu)
    model = twin.model_of(component)
    assert model is not None
    twin.compare_with_model(component, model, report)
    component.close()
    return report


@pytest.mark.parametrize("fmu", ["bushing", "housing", "rigid_rotor", "amb_controller", "amb_actuator"])
def test_an_fmu_of_the_project_passes_its_check_and_equals_its_model(fmu: str) -> None:
    """One of each role; continuous integration checks all of them."""
    report = check_fmu(fmu)
    assert report.problems == []
    assert LINE in report.lines
    of_model = port_sides(InProcessComponent(fmu, recipe(fmu).model))
    told = sum(line.startswith("port ") and "; without" not in line for line in report.lines)
    assert told == len(of_model)
    assert any(side != "sensor" for side in of_model.values()) == (fmu != "amb_controller")


def test_the_rig_presses_the_journal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Into the bore, from values that are the FMU's own: another clearance is no difference."""
    seen: list[float] = []
    drive = twin._run

    def noted(component, read, clearance):
        for values in drive(component, read, clearance):
            seen.append(values[read.index("contact.force")])
            yield values

    monkeypatch.setattr(twin, "_run", noted)
    changed = recipe("bushing").starting_from({"clearance": 2e-4})
    assert compared(build_fmu(changed, tmp_path)) == CheckReport("", [], [LINE])
    assert max(seen) > 1.0  # N
    assert min(seen) == 0.0


def test_the_first_difference_is_told(built: Mapping[str, Path], tmp_path: Path) -> None:
    """Of an FMU that carries other sources, with another kinetic energy."""
    entries = entries_of(built["rigid_rotor"])
    (source,) = (name for name in entries if name.endswith("rotor/rigid.py"))
    path = saying(built["rigid_rotor"], tmp_path / "changed.fmu", "0.5 * ", "0.6 * ", source)
    (problem,) = check_fmu(str(path)).problems
    told = r"50 steps of 2e-05 s: \S+ is \S+ J at t = \S+ s, and \S+ J in the installed model; the FMU was"
    assert re.match(told, problem)


@pytest.mark.parametrize("both", [True, False])
def test_numbers_that_both_do_not_have_are_equal(
    both: bool, monkeypatch: pytest.MonkeyPatch, built: Mapping[str, Path]
) -> None:
    drive = twin._run

    def spoilt(component, read, clearance):
        for values in drive(component, read, clearance):
            of_model = isinstance(component, InProcessComponent)
            yield [math.nan, *values[1:]] if both or of_model else values

    monkeypatch.setattr(twin, "_run", spoilt)
    problems = compared(built["rigid_rotor"]).problems
    assert [" nan " in problem for problem in problems] == ([] if both else [True])


def test_ctrl_c_is_not_counted_against_the_fmu(monkeypatch: pytest.MonkeyPatch) -> None:
    """An exception in the middle of its Python code would be an error that it returns."""
    calls = list[str]()

    def interrupted(component: object, report: object) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        calls.append("went on")

    monkeypatch.setattr(check, "_dry_run", interrupted)
    with pytest.raises(KeyboardInterrupt):
        check_fmu("housing")
    assert calls == ["went on"]
