"""Connections of integers, Booleans and choices: held over a macro step, never scaled, types that fit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from archives import archive, entries_of, saying
from misbehaving import COMPILER, compiled, misbehaving
from pythonfmu import FmuBuilder
from systems import history, recorded

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.description import interface
from touchdown.master.coupling.loop.compiled_loop import PythonLoop
from touchdown.master.coupling.observer import RunState
from touchdown.master.coupling.simulation import open_system, opened
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.interop.ssp.xml import SSD_FILE
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene, parse_scene
from touchdown.master.scene.scene import ComponentSpec, Scene, Wire

STEP, STEPS = 1e-3, 12  # s
GIVER = '''
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Integer, Real, String


class Giver(Fmi2Slave):
    """Counts its steps from 5 on."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.n, self.on, self.choice, self.x, self.word = 5, True, 3, 0.5, "a"
        out = {"causality": Fmi2Causality.output}
        self.register_variable(Integer("n", **out))
        self.register_variable(Boolean("on", **out))
        self.register_variable(Integer("choice", **out))
        self.register_variable(Real("x", **out))
        self.register_variable(String("word", **out))

    def do_step(self, current_time, step_size):
        self.n, self.on, self.choice = self.n + 1, not self.on, 5 - self.choice
        self.x += 0.25
        return True
'''
TAKER = '''
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Integer, Real, String


class Taker(Fmi2Slave):
    """Tells what it is given, as it was throughout its last step."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.n, self.on, self._choice, self.x, self.word = 1, False, 2, 0.0, "true"
        self.told_n = self.told_choice = -1
        self.told_on, self.told_x = False, -1.0
        taken, out = {"causality": Fmi2Causality.input}, {"causality": Fmi2Causality.output}
        self.register_variable(Integer("n", **taken))
        self.register_variable(Boolean("on", **taken))
        self.register_variable(Integer("choice", **taken))
        self.register_variable(Real("x", **taken))
        self.register_variable(String("word", **taken))
        self.register_variable(Integer("told_n", **out))
        self.register_variable(Boolean("told_on", **out))
        self.register_variable(Integer("told_choice", **out))
        self.register_variable(Real("told_x", **out))

    @property
    def choice(self):
        return self._choice

    @choice.setter
    def choice(self, value):
        if value not in (2, 3):
            raise ValueError(f"{value} is no choice")
        self._choice = value

    def do_step(self, current_time, step_size):
        self.told_n, self.told_on, self.told_choice, self.told_x = self.n, self.on, self.choice, self.x
        return True
'''
CHOICES = (
    '<TypeDefinitions><SimpleType name="Choice"><Enumeration><Item name="two" value="2"/>'
    '<Item name="three" value="3"/></Enumeration></SimpleType></TypeDefinitions>'
)
FED = ("n", "on", "choice", "x")


def change(path: Path, name: tuple[str, str], kind: tuple[str, str], types: str = "") -> None:
    """Put a variable of another name and kind into an FMU's description, before and after, and types."""
    entries = entries_of(path)
    head, found, tail = entries["modelDescription.xml"].decode().partition(f'name="{name[0]}')
    assert found
    head = head.replace("<ModelVariables>", f"{types}<ModelVariables>")
    text = f'{head}name="{name[1]}{tail.replace(*kind, 1)}'
    archive(path, {**entries, "modelDescription.xml": text})


def chosen(path: Path) -> None:
    """Make the Integer `choice` of an FMU an Enumeration of 2 and 3, without a 0."""
    change(path, ('choice"', 'choice"'), ("<Integer", '<Enumeration declaredType="Choice"'), CHOICES)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Giver.fmu, and Taker.fmu, whose `choice` is an enumeration."""
    folder = tmp_path_factory.mktemp("kinds")
    for name, source in (("giver", GIVER), ("taker", TAKER)):
        (folder / f"{name}.py").write_text(source)
        FmuBuilder.build_FMU(folder / f"{name}.py", dest=folder)
    chosen(folder / "Taker.fmu")
    return folder


def pair(folder: Path, **more: object) -> Scene:
    """The one feeds the other."""
    parts = {name: {"fmu": f"{name.title()}.fmu"} for name in ("giver", "taker")}
    run = {"duration": STEPS * STEP, "macro_step": STEP, "record_every": 1}
    connect = [[f"giver.{name}", f"taker.{name}"] for name in FED]
    return parse_scene({"components": parts, "connect": connect, "run": run, **more}, "pair", folder)


@pytest.mark.parametrize(("scheme", "late", "isolate"), [("interface", 0, False), ("jacobi-hold", 1, True)])
def test_values_are_held_over_a_step(
    scheme: str, late: int, isolate: bool, folder: Path, tmp_path: Path
) -> None:
    """Those of the step just taken, or all at once of the one before; all of them are recorded."""
    scene = pair(folder).set({"run.scheme": scheme, "giver.isolate": isolate, "taker.isolate": isolate})
    run_scene(scene, tmp_path / "out")
    values = recorded(tmp_path / "out")
    steps = np.arange(STEPS + 1)
    given = {"n": 5 + steps, "on": 1 - steps % 2, "choice": 3 - steps % 2, "x": 0.5 + 0.25 * steps}
    for name in FED:
        assert np.array_equal(values[f"giver/{name}"], given[name]), name
        assert np.array_equal(values[f"taker/told_{name}"][1:], given[name][1 - late : STEPS + 1 - late]), (
            name
        )


def test_compiled_code_records_what_it_does_not_exchange(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Booleans and whole numbers, where all that is connected is Real."""
    taken: list[int] = []
    take = PythonLoop.take

    def counting(steps: PythonLoop, now: RunState) -> None:
        taken.append(now.done)
        take(steps, now)

    monkeypatch.setattr(PythonLoop, "take", counting)
    scene = pair(folder, connect=[["giver.x", "taker.x"]]).set({"*.isolate": False})
    run_scene(scene, tmp_path / "out")
    assert taken == [0]  # the others are taken in compiled code
    values, steps = recorded(tmp_path / "out"), np.arange(STEPS + 1)
    assert np.array_equal(values["giver/on"], 1 - steps % 2)
    assert np.array_equal(values["giver/n"], 5 + steps)


def test_inputs_of_one_output_start_each_from_its_own(folder: Path) -> None:
    """The one would refuse the other's start."""
    scene = pair(folder, connect=[["giver.choice", "taker.choice"], ["giver.choice", "taker.n"]])
    _, values, _ = history(scene, ["taker.told_choice", "taker.told_n"], in_process=False)
    assert np.array_equal(values["taker.told_choice"], values["taker.told_n"])
    assert set(values["taker.told_n"]) == {2, 3}


def test_words_are_no_starts_but_those_of_booleans(folder: Path) -> None:
    variables, *_ = interface(folder / "Taker.fmu", folder / "cache")
    assert variables["on"].start == 0.0
    assert variables["word"].start is None


def test_booleans_can_be_asked_for_after_the_run(folder: Path, tmp_path: Path) -> None:
    """In memory, and in what its folder keeps."""
    result = run_scene(pair(folder), tmp_path / "out")
    for told in (result, touchdown.open_result(tmp_path / "out")):
        assert told.ending.value("giver.on") == 1 - STEPS % 2
        assert told.ending.value("taker.told_on") == 1 - STEPS % 2


@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
@pytest.mark.parametrize("listens", [False, True])
def test_true_is_one_whatever_an_fmu_says(listens: bool, folder: Path, tmp_path: Path) -> None:
    """It says 2; where none listens, compiled code records it."""
    fmu = misbehaving(compiled(tmp_path), "never", "nothing")
    change(fmu, ('journal.jump"', 'on"'), ('<Real unit="J"/>', "<Boolean/>"))
    parts = {"says": {"fmu": str(fmu)}, "taker": {"fmu": "Taker.fmu"}}
    connect = [["says.on", "taker.on"]] if listens else []
    run_scene(pair(folder, components=parts, connect=connect), tmp_path / "out")
    values = recorded(tmp_path / "out")
    assert values["says/on"] == pytest.approx(1.0)
    assert values["taker/told_on"][1:] == pytest.approx(float(listens))


def test_an_integer_may_feed_what_is_real(folder: Path) -> None:
    scene = pair(folder, connect=[["giver.n", "taker.x"]])
    _, values, _ = history(scene, ["taker.told_x"], in_process=False)
    assert np.array_equal(values["taker.told_x"], 6.0 + np.arange(STEPS))


def test_a_drop_is_the_same_beside_a_component_that_listens(folder: Path, tmp_path: Path) -> None:
    """To whether the magnetic bearing is active: step by step, where compiled code takes the drop alone."""
    scene = load_scene("disk-caged-simplified").set({"amb.shutdown_time": 1e-3, "run.duration": 9e-3})
    listening = {**scene.components, "taker": ComponentSpec(str(folder / "Taker.fmu"))}
    beside = replace(scene, components=listening, connect=(Wire("amb.active", "taker.n"),))
    with opened(beside, in_process=True) as system:
        assert system.components["amb"].by_address() is None
    alone, heard = (
        recorded(run_scene(s, tmp_path / name, in_process=True).folder)
        for s, name in ((scene, "alone"), (beside, "beside"))
    )
    assert alone["bearing/contact.force"].max() > 100.0
    assert [name for name in alone if not np.array_equal(alone[name], heard[name])] == []
    told = heard["taker/told_n"][1:]
    assert (told[0], told[-1]) == (1, 0)
    assert np.array_equal(told, heard["amb/active"][1:])


@pytest.mark.parametrize(
    ("wire", "line"),
    [
        (["giver.x", "taker.n"], "it leads from the type Real to Integer; types must be the same"),
        (["giver.n", "taker.on"], "it leads from the type Integer to Boolean; types must be"),
        (["giver.word", "taker.word"], "it leads from the type String to String; types must be"),
        (["giver.n", "taker.n", 2.0, 0.0],
         "only what is Real can be scaled, and it leads from the type Int"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_one_line(wire: list[object], line: str, folder: Path) -> None:
    with pytest.raises(TouchdownError, match=line) as refused:
        open_system(pair(folder, connect=[wire])).close()
    assert "\n" not in str(refused.value)


def test_a_bond_is_real(folder: Path) -> None:
    bond = [["giver.x", "taker.x"], ["taker.told_n", "giver.n"]]
    with pytest.raises(
        TouchdownError, match="a bond is Real, and it leads from the type Integer to Integer"
    ):
        open_system(pair(folder, connect=[], bond=bond)).close()


def test_packages_have_such_connections(folder: Path, tmp_path: Path) -> None:
    """Written, with their types, and read again; a choice goes as its number."""
    scene = pair(folder)
    path = write_ssp(scene, tmp_path / "pair.ssp").path
    said = entries_of(path)[SSD_FILE].decode()
    assert said.count("<ssc:Boolean") == 2
    assert said.count("<ssc:Integer") == 4
    assert "LinearTransformation" not in said
    names = [f"taker.told_{name}" for name in FED]
    _, values, _ = history(scene, names, in_process=False)
    _, again, _ = history(find_scene(str(path)), names, in_process=False)
    for name in names:
        assert np.array_equal(values[name], again[name]), name


def test_a_package_scales_no_integers(folder: Path, tmp_path: Path) -> None:
    """Where nothing is to be converted, it may say so."""
    path = write_ssp(pair(folder), tmp_path / "pair.ssp").path
    ends = 'startElement="giver" startConnector="n" endElement="taker" endConnector="n"'

    def opened_with(switch: str, inside: str) -> None:
        wire = f"<ssd:Connection {ends}{switch}>{inside}</ssd:Connection>"
        changed = saying(path, tmp_path / "changed.ssp", f"<ssd:Connection {ends} />", wire, SSD_FILE)
        open_system(find_scene(str(changed))).close()

    opened_with(' suppressUnitConversion="true"', "")
    with pytest.raises(TouchdownError, match="only what is Real can be scaled"):
        opened_with("", '<ssc:LinearTransformation factor="2"/>')
