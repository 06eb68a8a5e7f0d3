"""Attributes of model descriptions: each is used, checked or named as ignored; none is just believed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring, parse

import fmpy
import pytest
from archives import saying
from pythonfmu import FmuBuilder
from systems import recorded

from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.common.units import Unit
from touchdown.master.components.attributes import ATTRIBUTES, Use, ignored, mend, treatment
from touchdown.master.components.description import read_description, variables_of
from touchdown.master.components.unpack import unpack
from touchdown.master.interop.check import check_fmu
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

XSD = "{http://www.w3.org/2001/XMLSchema}"
SOURCE = '''
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Source(Fmi2Slave):
    """Gives the end of the run, and a temperature that it declares constant."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.T, self.dT, self.seen, self.stop = 300.0, 0.0, 0.0, -1.0
        out = {"causality": Fmi2Causality.output}
        self.register_variable(Real("T", variability=Fmi2Variability.constant, start=300.0, **out))
        self.register_variable(Real("dT", causality=Fmi2Causality.input))
        self.register_variable(Real("seen", **out))
        self.register_variable(Real("stop", **out))

    def setup_experiment(self, start_time, stop_time, tolerance):
        self.stop = -1.0 if stop_time is None else stop_time

    def do_step(self, current_time, step_size):
        if self.step_taken() and abs(step_size - 0.25) > 1e-9:
            return False
        self.T, self.seen = 300.0 + 10.0 * (current_time + step_size), self.dT
        return True

    def step_taken(self):
        return FIXED
'''
SCENE = """
[run]
duration = "0.5 s"
macro_step = "{step}"
record_every = 1
[components.a]
fmu = "Source.fmu"
{more}
"""


def attributes(version: str) -> Iterator[tuple[str, str]]:
    """All attributes of the schemas of a version of FMI, each with the element or type that has it."""

    def within(node: Element, owner: str) -> Iterator[tuple[str, str]]:
        for inner in node:
            if inner.tag == f"{XSD}attribute":
                yield owner, (inner.get("name") or inner.get("ref", "")).rpartition(":")[2]
            named = inner.get("name") if inner.tag != f"{XSD}attribute" else None
            yield from within(inner, named or owner)

    for path in sorted((Path(fmpy.__file__).parent / "schema" / version).glob("*.xsd")):
        yield from within(parse(path).getroot(), path.stem)


def test_the_table_has_every_attribute_of_the_schemas_and_no_other() -> None:
    found = [*attributes("fmi2"), *attributes("fmi3")]
    assert len(found) > 200
    assert [one for one in found if treatment(*one) is None] == []
    names = {name for _, name in found} | {".".join(one) for one in found}
    assert set(ATTRIBUTES) <= names
    assert all(known.says for known in ATTRIBUTES.values() if known.use is not Use.TEXT)


def test_what_is_set_and_ignored_is_named_once() -> None:
    root = fromstring(
        '<fmiModelDescription><CoSimulation canInterpolateInputs="true" canRunAsynchronuously="false"/>'
        '<ModelVariables><v canHandleMultipleSetPerTimeInstant="false"/>'
        '<v canHandleMultipleSetPerTimeInstant="false"/></ModelVariables>'
        '<DefaultExperiment startTime="0.0"/><VendorAnnotations>'
        '<Tool tolerance="1e-3"/></VendorAnnotations></fmiModelDescription>'
    )
    assert [line.partition(" ")[0] for line in ignored(root)] == [
        "canInterpolateInputs",
        "canHandleMultipleSetPerTimeInstant",
    ]


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[bool, Path]:
    """An FMU of SOURCE that takes steps of any length, and one that takes steps of 0.25 s alone."""
    folder = tmp_path_factory.mktemp("source")
    made: dict[bool, Path] = {}
    for fixed in (False, True):
        script = folder / str(fixed) / "source.py"
        script.parent.mkdir()
        script.write_text(SOURCE.replace("FIXED", str(fixed)))
        made[fixed] = FmuBuilder.build_FMU(script, dest=script.parent)
    return made


def scene_of(folder: Path, step: str, more: str = "", head: str = "") -> Scene:
    """A scene of `Source.fmu` in `folder`."""
    path = folder / "scene.toml"
    path.write_text(head + SCENE.format(step=step, more=more), encoding="utf-8")
    return load_scene(str(path))


def described(source: Path, to: Path, old: str, new: str) -> Path:
    return saying(source, to / "Source.fmu", old, new)


def test_an_output_declared_constant_that_changes_is_exchanged(
    fmus: dict[bool, Path], tmp_path: Path
) -> None:
    more = '[components.b]\nfmu = "Source.fmu"'
    scene = scene_of(fmus[False].parent, "50 ms", more, 'connect = [["a.T", "b.dT"]]')
    run_scene(scene, tmp_path)
    columns = recorded(tmp_path)
    assert columns["a/T"][-1] == pytest.approx(305.0)
    assert columns["b/seen"][-1] == pytest.approx(305.0, abs=0.51)  # one macro step of 0.5 K behind at most
    assert columns["a/stop"][-1] == pytest.approx(0.5)  # s; without, it says -1
    assert any("T is declared constant and changes" in one for one in check_fmu(str(fmus[False])).lines)


def test_a_step_that_an_fmu_states_is_the_one_it_is_checked_by(
    fmus: dict[bool, Path], tmp_path: Path
) -> None:
    old = 'canHandleVariableCommunicationStepSize="true"'
    path = described(fmus[True], tmp_path, old, old.replace("true", "false"))
    assert check_fmu(str(path)).problems  # it states no step: 10 us are refused
    stating = tmp_path / "stating"
    stating.mkdir()
    experiment = '<DefaultExperiment stepSize="0.25" stopTime="0.75"/><ModelVariables>'
    path = described(path, stating, "<ModelVariables>", experiment)
    report = check_fmu(str(path))
    assert not report.problems
    assert "dry run: 3 steps of 0.25 s, outputs finite" in report.lines
    result = run_scene(scene_of(stating, "0.5 s"), tmp_path / "out")
    assert any("takes steps of 0.25 s alone" in line for line in result.warnings)


@pytest.mark.parametrize(
    ("name", "setting", "value"),
    [
        ("disk-cageless-line", "amb.every", 2),
        ("disk-bore-axis-failure", "controller.sampled", "100 us"),
    ],
)
def test_no_step_ends_after_the_stop_time(name: str, setting: str, value: object, tmp_path: Path) -> None:
    """Also of components that take longer steps than the run; the project's FMUs refuse those that do."""
    scene = load_scene(name)
    steps = 7 * scene.run.macro_step  # s; no whole number of the component's
    result = run_scene(scene.set({setting: value, "run.duration": steps}), tmp_path)
    assert result.ended is Ended.COMPLETED


def test_an_fmu_for_one_instance_in_a_process_has_processes(fmus: dict[bool, Path], tmp_path: Path) -> None:
    old = 'canBeInstantiatedOnlyOncePerProcess="false"'
    path = described(fmus[False], tmp_path, old, old.replace("false", "true"))
    more = '[components.b]\nfmu = "Source.fmu"'
    scene = scene_of(path.parent, "0.1 s", more)
    run_scene(scene, tmp_path / "out")
    scene = scene.set({"a.isolate": False, "b.isolate": False})
    with pytest.raises(TouchdownError, match="instantiated only once in a process, and is a already"):
        run_scene(scene, tmp_path / "in")


def test_a_difference_is_converted_without_the_offset_of_its_unit() -> None:
    celsius, kelvin = Unit({"K": 1}, offset=273.15), Unit({"K": 1})
    assert celsius.to(kelvin) == (1.0, 273.15)
    assert celsius.to(kelvin, relative=True) == (1.0, 0.0)
    fahrenheit = Unit({"K": 1}, 5.0 / 9.0, 255.372)
    assert fahrenheit.to(celsius, relative=True) == (pytest.approx(5.0 / 9.0), 0.0)


def test_a_difference_is_known_by_its_variable_or_its_type(fmus: dict[bool, Path], tmp_path: Path) -> None:
    types = '<TypeDefinitions><SimpleType name="Rise"><Real relativeQuantity="true"/></SimpleType>'
    path = described(
        fmus[False], tmp_path, "<ModelVariables>", f"{types}</TypeDefinitions><ModelVariables>"
    )
    text = (unpack(path, tmp_path / "cache") / "modelDescription.xml").read_text()
    assert text.count("<Real") > 3
    other = tmp_path / "other"
    other.mkdir()
    (other / "modelDescription.xml").write_text(text)
    first = text.index("<Real", text.index('name="dT"'))
    second = text.index("<Real", text.index('name="seen"'))
    changed = f'{text[:first]}<Real relativeQuantity="true"{text[first + 5 : second]}'
    changed += f'<Real declaredType="Rise"{text[second + 5 :]}'
    known = saying(path, other / "Source.fmu", text, changed)
    variables = variables_of(read_description(known, unpack(known, tmp_path / "cache")))
    assert {name for name, v in variables.items() if v.relative} == {"dT", "seen"}


def test_what_tools_write_beside_the_standard_is_read_and_named() -> None:
    root = fromstring(
        '<fmiModelDescription fmiVersion="2.0"><ModelVariables>'
        '<ScalarVariable name="k" causality="parameter" variability="constant"><Real/></ScalarVariable>'
        '<ScalarVariable name="i" causality="input" variability="fixed"><Real/></ScalarVariable>'
        '<ScalarVariable name="p" causality="parameter"><Real declaredType="Nowhere"/></ScalarVariable>'
        '<ScalarVariable name="y" causality="output"><Real/></ScalarVariable></ModelVariables>'
        '<ModelStructure><Outputs><Unknown index="4"/><Unknown index="9"/></Outputs></ModelStructure>'
        "</fmiModelDescription>"
    )
    lines = mend(root)
    assert [line.split()[1] for line in lines[:-1]] == ["k", "i", "p", "p"]
    assert lines[-1] == "ModelStructure/Outputs names a variable that is not there"
    assert mend(root) == []
    assert [one.get("index") for one in root.iter("Unknown")] == ["4"]
