"""Controllers of others, good and bad: what `touchdown check --as controller` says of them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from archives import archive, entries_of
from places import ROOT
from pythonfmu import FmuBuilder

from touchdown.command.cli import main
from touchdown.fmus.recipes import recipe
from touchdown.master.components.component import Component
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.components.loading import Stepping, load_component
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.contract import CheckReport, check_role
from touchdown.master.interop.controller_response import PERIOD, move_axes
from touchdown.master.scene.file import read_names

SCRIPT = ROOT / "examples" / "pid_controller.py"
NAMES = ROOT / "examples" / "pid_controller.toml"
ANSWER = "        self.cur_a = self.answer"

Built = Callable[..., Path]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """The example with some of its text replaced, as an FMU."""

    def build(name: str, replaced: Mapping[str, str]) -> Path:
        folder = tmp_path_factory.mktemp(name.lower())
        text = SCRIPT.read_text(encoding="utf-8").replace("class PidController", f"class {name}")
        for before, after in replaced.items():
            assert before in text
            text = text.replace(before, after)
        script = folder / f"{folder.name}.py"  # Python keeps a module by its name
        script.write_text(text, encoding="utf-8")
        FmuBuilder.build_FMU(script, dest=folder)
        return folder / f"{name}.fmu"

    return build


def pressed(path: Path) -> CheckReport:
    """What is found of its answers, and nothing else; it is stepped in this process."""

    def load() -> Component:
        component = load_component("checked", str(path), stepping=Stepping(isolate=False))
        component.rename(read_names(NAMES))
        return component

    report = CheckReport(path.name)
    move_axes(load, PERIOD, report)
    return report


def test_the_example_passes(built: Built, capsys: pytest.CaptureFixture[str]):
    path = built("GoodController", {})
    assert main(["check", str(path), "--as", "controller", "--names", str(NAMES)]) == 0
    said = capsys.readouterr().out
    assert "axis 2: a rotor off the centre is pulled back, at 1.06e+04 A/m" in said
    assert "it answers in the call of the sample, which makes 1 sample of delay in the loop" in said
    assert 'it answers at every call: step it once a sample, sampled = "100 us" in its table' in said
    assert "it can stand in for a controller" in said


def test_a_sign_a_silence_and_axes_the_wrong_way_round_are_problems(built: Built):
    for name, replaced, said in (
        (
            "TurnedController",
            {"-self.pos_b": "self.pos_b"},
            "axis 2 is pushed further out: axis\\[2\\].set",
        ),
        ("SilentController", {"-self.pos_b": "0.0"}, "axis 2 does not change axis\\[2\\].set within 10"),
        (
            "CrossedController",
            {"-self.pos_a": "-self.pos_X", "-self.pos_b": "-self.pos_a", "pos_X": "pos_b"},
            "does not change axis\\[1\\].set, but that of axis 2; name its variables the other way round",
        ),
    ):
        assert any(re.search(said, problem) for problem in pressed(built(name, replaced)).problems)


def test_millimetres_are_said(built: Built):
    path = built("MetricController", {"-self.pos_a": "-1e-3 * self.pos_a"})
    assert "warning: 10.6 A/m on axis 1; controllers have 100 to 1e+07 A/m" in pressed(path).text


FORCES = {name.replace(".set", ".force_set"): own for name, own in read_names(NAMES).items()}


def stating(path: Path, unit: str) -> Path:
    """The FMU, whose set points have a unit in its description."""
    entries, other = entries_of(path), path.with_name(f"in_{unit}_{path.name}")
    units = f'<UnitDefinitions><Unit name="{unit}"/></UnitDefinitions><ModelVariables>'
    text = entries["modelDescription.xml"].decode().replace("<ModelVariables>", units)
    stated = rf'\1 unit="{unit}"'
    text, count = re.subn(r'(name="cur_[ab]".*?<Real)', stated, text, flags=re.DOTALL)
    assert count == 2
    return archive(other, {**entries, "modelDescription.xml": text})


def test_forces_are_in_newtons(built: Built):
    """Set points called `force_set`, stiff ones, are no amperes; a unit that is stated must be theirs."""
    path = built("ForceController", {"9.7e3": "2.3e7", "6000.0, 4.0": "6000.0, 4e3"})
    for fmu, names, problems in (
        (stating(path, "N"), FORCES, []),
        (stating(path, "N"), read_names(NAMES), ["in N, not in A"] * 2),
        (stating(path, "A"), FORCES, ["in A, not in N"] * 2),
    ):
        report = check_fmu(str(fmu), "controller", names)
        assert [problem.partition(" is ")[2] for problem in report.problems] == problems
        if not problems:
            assert "is pulled back, at 2.3e+07 N/m" in report.text
            assert "axis 2: it commands forces; set the actuator's command = force" in report.text
            assert "A/m" not in report.text


@pytest.mark.parametrize("coupled", [1e-8, 0.2])
def test_axes_the_wrong_way_round_are_found_whatever_else_couples_them(built: Built, coupled: float):
    """An axis' own answer must be the largest to a move along it, not merely one."""
    ways = {"-self.pos_a": "A_WAY", "-self.pos_b": "B_WAY"}
    a, b = (f"-self.pos_{n} - {coupled} * self.pos_{m}" for n, m in (("a", "b"), ("b", "a")))
    crossed = pressed(built("TiedController", {**ways, "A_WAY": b, "B_WAY": a})).problems
    assert len(crossed) == 2
    share = "does not change axis[1].set, but" if coupled < 1e-2 else "by 0.014 A, and"
    assert f"{share} that of axis 2" in crossed[0]
    assert crossed[0].endswith("name its variables the other way round")
    assert pressed(built("CoupledController", {**ways, "A_WAY": a, "B_WAY": b})).problems == []


def test_its_delay_is_said(built: Built):
    late = {ANSWER: "        self.cur_a, self.cur_b, old = *self.old, None\n        old_a = self.answer"}
    late |= {
        "self.cur_b = self.answer": "old_b = self.answer",
        "return True": "self.old = old_a, old_b\n        return True",
    }
    late |= {"self.memory = None": "self.old = 0.0, 0.0\n        self.memory = None"}
    assert (
        "it answers 1 samples after it, which makes 2 samples of delay"
        in pressed(built("LateController", late)).text
    )
    tied = {"-self.pos_a": "-self.pos_a - 1e-8 * self.pos_b"}  # an axis moved before still changes it
    assert "answers 1 samples after it" in pressed(built("LateTiedController", {**tied, **late})).text


def test_one_that_skips_samples_by_rounding_is_a_problem(built: Built):
    """It counts periods by the time, without a margin."""
    own = "        if int((current_time + step_size) / 1e-4) <= self.seen:\n            return True\n"
    own += "        self.seen = int((current_time + step_size) / 1e-4)\n"
    skipping = {ANSWER: own + ANSWER, "self.memory = None": "self.seen = 0\n        self.memory = None"}
    seen = {math.floor((k * PERIOD + PERIOD) / 1e-4) for k in range(1000)} - {0}
    assert len(seen) < 990
    (problem,) = pressed(built("SkippingController", skipping)).problems
    assert problem.startswith(f"it takes {len(seen)} of 1000 samples, called once every 100 us")


def test_one_with_its_own_clock_may_be_stepped_at_every_macro_step(built: Built):
    own = (
        "        if int((current_time + step_size) / 1e-4 + 1e-6) <= self.seen:\n            return True\n"
    )
    own += "        self.seen = int((current_time + step_size) / 1e-4 + 1e-6)\n"
    clocked = {ANSWER: own + ANSWER, "self.memory = None": "self.seen = 0\n        self.memory = None"}
    report = pressed(built("ClockedController", clocked))
    assert "called more often, it uses each sample once: every macro step will do" in report.text
    assert not report.problems


def test_the_projects_own_passes_and_what_is_none_is_said():
    report = CheckReport("amb_controller")
    move_axes(lambda: InProcessComponent("controller", recipe("amb_controller").model), PERIOD, report)
    assert report.problems == []
    check_role(InProcessComponent("bushing", recipe("bushing").model), "controller", report)
    assert "axis[1].sensed is missing (input in m)" in report.problems[0]
