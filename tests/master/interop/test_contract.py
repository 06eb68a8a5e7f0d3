"""The contract over every FMU: complete ports, and bearings that answer simple questions alike."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from archives import archive, entries_of
from systems import history, rotor_on

from touchdown.fmus.build import cached_fmu
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.components.component import ScalarVariable
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.contract import CheckReport, check_ports, port_sides

COMPONENTS = {name: InProcessComponent(name, recipe(name).model) for name in fmu_names()}
PORTS = {name: port_sides(component) for name, component in COMPONENTS.items()}
BEARINGS = [name for name in fmu_names() if "journal" in PORTS[name]]
MAGNETS = ("amb", "amb_actuator", "amb_axial", "exciter")  # they pull at a journal, and none touches them
TOUCHED = [name for name in BEARINGS if "contact.first_time" in COMPONENTS[name].variables]
SHIPPED = {  # a new one needs no entry
    *("angular_caged", "angular_cageless", "bushing"),
    *("detailed_caged", "detailed_cageless", "simplified_caged", "simplified_cageless"),
}


def test_the_bearings_are_known() -> None:
    assert SHIPPED | set(MAGNETS) <= set(BEARINGS)
    assert set(TOUCHED) >= SHIPPED


def test_a_wrong_unit_and_a_missing_variable_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the check says of a bearing in millimetres without a vertical force."""
    component, report = InProcessComponent("bushing", recipe("bushing").model), CheckReport("")
    variables = dict(component.variables)
    variables["journal.x"] = ScalarVariable(**{**vars(variables["journal.x"]), "unit": "mm"})
    del variables["journal.fy"]
    monkeypatch.setattr(component, "variables", variables)
    check_ports(component, report)
    assert "journal.x is in mm, not in m" in report.problems
    assert any("journal.fy is missing" in problem for problem in report.problems)


@pytest.mark.slow
def test_initial_unknowns_that_are_not_listed_are_a_finding(tmp_path: Path) -> None:
    """The schema leaves the element out; what is listed wrongly is a problem."""
    entries = entries_of(cached_fmu(recipe("bushing")))
    text = entries["modelDescription.xml"].decode()
    first, last = text.index("<InitialUnknowns>"), text.index("</InitialUnknowns>")
    unknown = text[text.index("<Unknown", first) : text.index("/>", first) + 2]
    for kept, problems in (("", 0), (f"<InitialUnknowns>{unknown}</InitialUnknowns>", 1)):
        described = text[:first] + kept + text[last + len("</InitialUnknowns>") :]
        path = archive(tmp_path / f"{problems}.fmu", {**entries, "modelDescription.xml": described})
        report = check_fmu(str(path))
        assert len(report.problems) == problems
        assert any("lists no InitialUnknowns" in line for line in report.lines) != bool(problems)
        assert "valid FMI 2.0 for co-simulation" not in report.lines
        but = "valid FMI 2.0 for co-simulation but for its InitialUnknowns"
        assert (but in report.lines) != bool(problems)


@pytest.mark.parametrize("name", [n for n in BEARINGS if n not in MAGNETS])
def test_a_prescribed_journal_needs_no_interface_model(name: str) -> None:
    """With inv_m unconnected the motion is taken as given: a journal moved into the bore meets a force."""
    component = InProcessComponent("bearing", recipe(name).model)
    outputs = np.zeros(2)
    inputs = ["journal.x", "journal.y", "journal.vx", "journal.vy"]
    component.bind(inputs, outputs, ["journal.fx", "journal.fy"])
    component.enter(0.0)
    component.exit()
    for k in range(400):
        depth = 0.29e-3 + k * 1e-7
        component.inputs[:] = 0.0, -depth, 0.0, -1e-7 / 2e-5
        component.push()
        component.step(k * 2e-5, 2e-5)
        component.pull()
    assert outputs[1] > 10.0
    assert abs(outputs[0]) < outputs[1]


@pytest.mark.parametrize("name", TOUCHED)
def test_the_first_contact_is_reported_alike(name: str) -> None:
    rotor = {"y": -0.2e-3, "vy": -0.05, "gravity": 0.0, "speed": 0.0}
    times, found, _ = history(
        rotor_on(name, rotor, duration=4e-3, macro_step=1e-4), ["bearing.contact.first_time", "rotor.A.y"]
    )
    first = found["bearing.contact.first_time"][-1]
    sagged = name.endswith("_caged") or name == "angular_simplified"  # the ring, by its play
    gap = 0.1e-3 + (5e-6 if sagged else 0.0)
    assert first == pytest.approx(gap / 0.05, rel=0.01)
    assert times[-1] > first
