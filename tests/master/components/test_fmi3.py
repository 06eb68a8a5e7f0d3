"""FMUs of FMI 3.0 as components: arrays, types of numbers, what is refused; a probe changes nothing."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from archives import archive, saying
from fmpy import platform_tuple
from hosting import COMPILER
from systems import history, recorded

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import fill_values as put_values
from touchdown.master.coupling.simulation import open_system, opened, simulate
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.interop.ssp.xml import NAMESPACES, SSD_FILE
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene, parse_scene
from touchdown.master.scene.scene import ComponentSpec, Scene, Wire

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")

TWO = '<Dimension start="2"/>'
CALCULATED = 'initial="calculated"'
DESCRIPTION = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="probe" instantiationToken="{{probe}}">
<CoSimulation modelIdentifier="probe3"/>
<UnitDefinitions><Unit name="m"><BaseUnit m="1"/></Unit></UnitDefinitions>
<TypeDefinitions><EnumerationType name="Choice"><Item name="two" value="2"/>
<Item name="three" value="3"/></EnumerationType></TypeDefinitions>
<ModelVariables>
<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
<Float64 name="u" valueReference="1" causality="input" start="0 3" unit="m">{TWO}</Float64>
<Float64 name="gain" valueReference="2" causality="parameter" variability="fixed" start="2"/>
<Float64 name="y" valueReference="3" causality="output" initial="calculated">{TWO}</Float64>
<Int32 name="n" valueReference="4" causality="output" initial="calculated"/>
<UInt8 name="k" valueReference="5" causality="parameter" variability="fixed" start="7"/>
<Int64 name="big" valueReference="7" causality="output" initial="calculated"/>
<Boolean name="on" valueReference="8" causality="output" initial="calculated"/>
<Boolean name="heard" valueReference="9" causality="input" start="false"/>
<Enumeration name="choice" valueReference="10" declaredType="Choice" causality="output" {CALCULATED}/>
<Enumeration name="chosen" valueReference="11" declaredType="Choice" causality="input" start="2"/>
<Int32 name="many" valueReference="12" causality="calculatedParameter" variability="fixed" {CALCULATED}/>
<Int64 name="most" valueReference="13" causality="calculatedParameter" variability="fixed" {CALCULATED}/>
<Binary name="raw" valueReference="6" causality="input"><Start value="00"/></Binary>
</ModelVariables>
<ModelStructure><Output valueReference="3"/><Output valueReference="4"/>
<Output valueReference="7"/><Output valueReference="8"/><Output valueReference="10"/>
<InitialUnknown valueReference="3"/><InitialUnknown valueReference="4"/>
<InitialUnknown valueReference="7"/><InitialUnknown valueReference="8"/>
<InitialUnknown valueReference="10"/><InitialUnknown valueReference="12"/>
<InitialUnknown valueReference="13"/></ModelStructure>
</fmiModelDescription>"""


@pytest.fixture(scope="module")
def probe(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of probe3.c."""
    folder = tmp_path_factory.mktemp("fmi3")
    library, source = folder / "probe3.so", Path(__file__).with_name("probe3.c")
    assert COMPILER is not None
    command = [COMPILER, "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-o", library, source]
    subprocess.run(command, check=True)
    binary = {f"binaries/{platform_tuple}/probe3.so": library.read_bytes()}
    return archive(folder / "probe.fmu", {"modelDescription.xml": DESCRIPTION, **binary})


def alone(probe: Path, **changes: object) -> Scene:
    """The probe and nothing else."""
    component = {"fmu": str(probe), **changes}
    run = {"duration": 0.1, "macro_step": 0.01}
    return parse_scene({"components": {"probe": component}, "run": run}, "alone", probe.parent)


def test_the_check_passes_it(probe: Path) -> None:
    report = check_fmu(str(probe))
    assert report.problems == []
    assert "valid FMI 3.0 for co-simulation" in report.lines


@pytest.mark.parametrize("isolate", [False, True])
def test_arrays_are_scalars_and_numbers_of_all_sizes_are_set(isolate: bool, probe: Path) -> None:
    """Elements that are not set keep their start values."""
    scene = alone(probe, isolate=isolate, set={"gain": 3.0, "u[1]": 5e-3, "k": 255})
    with opened(scene) as system:
        assert simulate(scene, system).reason == ""
        found = [system.value(f"probe.{name}") for name in ("y[1]", "y[2]", "n", "k")]
    assert found == pytest.approx([0.015, 9.0, 10, 255])


@pytest.mark.parametrize("given", [[5e-3, 3], ("5 mm", 3.0), np.array([[5e-3], [3.0]])])
def test_arrays_are_set_whole(given: object, probe: Path) -> None:
    with opened(alone(probe).set({"probe.u": given})) as system:
        assert system.settings == {("probe", "u[1]"): 5e-3, ("probe", "u[2]"): 3.0}
    with pytest.raises(TouchdownError, match=r"probe\.u has 2 elements, and 3 values are given"):
        open_system(alone(probe, set={"u": [1, 2, 3]}))
    fed = {"fmu": str(probe), "set": {"u": [1, 2]}}
    scene = {"components": {"a": {"fmu": str(probe)}, "b": fed}, "connect": [["a.y[1]", "b.u[2]"]]}
    with pytest.raises(TouchdownError, match=r"b\.u\[2\] cannot be set: it is connected to a\.y\[1\]"):
        open_system(parse_scene(scene, "fed", probe.parent))


def packaged(fmu: Path, folder: Path, parameters: str) -> Scene:
    """The scene of a package in which these parameters of the FMU are set."""
    spaces = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())
    text = f"""<ssd:SystemStructureDescription {spaces} version="2.0" name="a">
<ssd:System name="s"><ssd:Elements>
<ssd:Component name="probe" source="resources/probe.fmu"><ssd:ParameterBindings><ssd:ParameterBinding>
<ssd:ParameterValues><ssv:ParameterSet version="2.0" name="u"><ssv:Parameters>{parameters}</ssv:Parameters>
<ssv:Units><ssc:Unit name="mm"><ssc:BaseUnit m="1" factor="0.001"/></ssc:Unit></ssv:Units>
</ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings></ssd:Component>
</ssd:Elements></ssd:System></ssd:SystemStructureDescription>"""
    return find_scene(
        str(archive(folder / "a.ssp", {SSD_FILE: text, "resources/probe.fmu": fmu.read_bytes()}))
    )


def test_arrays_are_set_whole_by_packages(probe: Path, tmp_path: Path) -> None:
    u = f'<ssv:Parameter name="u"><ssv:Float64 value="5 6" unit="mm"/>{TWO}</ssv:Parameter>'
    scene = packaged(probe, tmp_path, u)
    assert scene.components["probe"].set == pytest.approx({"u[1]": 5e-3, "u[2]": 6e-3})


def test_sizes_of_arrays_are_not_ignored_in_silence(probe: Path, tmp_path: Path) -> None:
    old = 'name="k" valueReference="5" causality="parameter"'
    sized = saying(probe, tmp_path / "sized.fmu", old, old.replace("parameter", "structuralParameter"))
    size = '<ssv:Parameter name="k"><ssv:UInt8 value="3"/></ssv:Parameter>'
    for scene in (alone(sized, set={"k": 3}), packaged(sized, tmp_path, size)):
        with pytest.raises(TouchdownError, match=r"probe\.k has the causality structuralParameter"):
            open_system(scene)


def test_a_probe_changes_no_bit_of_the_drop(probe: Path) -> None:
    """And it hears what its element was connected to."""
    scene = load_scene("disk-caged-simplified").set({"amb.shutdown_time": 0.0, "run.duration": 0.012})
    listening = {**scene.components, "probe": ComponentSpec(str(probe), isolate=False)}
    wires = (*scene.connect, Wire("rotor.A.y", "probe.u[2]"))
    watched = Scene(**{**vars(scene), "components": listening, "connect": wires})
    names = ["rotor.A.x", "rotor.A.y", "bearing.journal.fy"]
    _, without, _ = history(scene, names, in_process=False)
    _, values, _ = history(watched, [*names, "probe.y[2]", "probe.y[1]"], in_process=False)
    assert without["bearing.journal.fy"].max() > 100.0
    for name in names:
        assert np.array_equal(values[name], without[name])
    assert np.array_equal(values["probe.y[2]"], 2.0 * without["rotor.A.y"])
    assert not values["probe.y[1]"].any()


@pytest.fixture(scope="module")
def fed(probe: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The probe, whose parameter k is an input."""
    fixed = 'causality="parameter" variability="fixed" start="7"'
    return saying(probe, tmp_path_factory.mktemp("fed") / "fed.fmu", fixed, 'causality="input" start="7"')


def two(fed: Path, output: str, given: str, steps: int) -> Scene:
    """Two probes, a whole number of the one to the other."""
    parts = {name: {"fmu": str(fed)} for name in ("one", "other")}
    run = {"duration": steps * 1e-3, "macro_step": 1e-3}
    connect = [[f"one.{output}", f"other.{given}"]]
    return parse_scene({"components": parts, "connect": connect, "run": run}, "two", fed.parent)


def test_whole_numbers_cross_whatever_their_size(fed: Path) -> None:
    scene = two(fed, "n", "k", 9)
    _, values, _ = history(scene, ["one.n", "other.k"], in_process=False)
    assert np.array_equal(values["one.n"], np.arange(1, 10))
    assert np.array_equal(values["other.k"], np.arange(1, 10))


@pytest.mark.parametrize(
    ("output", "given", "line"),
    [
        ("n", "k", "component other: k is given 256, and holds whole numbers from 0 to 255"),
        ("big", "u[1]",
         f"component one: big = {2**53 + 1} cannot be exchanged; whole numbers can up to 2^53"),
    ],
)  # fmt: skip
def test_whole_numbers_that_would_become_others_are_refused(
    output: str, given: str, line: str, fed: Path
) -> None:
    scene = two(fed, output, given, 300)
    with opened(scene) as system:
        assert simulate(scene, system).reason == line


@pytest.mark.parametrize(
    ("output", "given", "line", "isolate"),
    [
        ("many", "k", "component other: k is given 300, and holds whole numbers from 0 to 255", False),
        ("most", "u[1]", f"component one: most = {2**53} cannot be handed over; constant whole", True),
    ],
)
def test_constants_that_would_become_others_are_refused(
    output: str, given: str, line: str, isolate: bool, fed: Path
) -> None:
    scene = two(fed, output, given, 3).set({"*.isolate": isolate})
    with opened(scene) as system, pytest.raises(TouchdownError) as refused:
        simulate(scene, system)
    assert str(refused.value).startswith(line)


def test_constants_cross_as_they_are(fed: Path) -> None:
    _, values, _ = history(two(fed, "many", "u[1]", 3), ["other.y[1]"], in_process=False)
    assert np.array_equal(values["other.y[1]"], np.full(3, 600.0))


def test_settings_that_a_type_cannot_hold_are_refused(probe: Path) -> None:
    with pytest.raises(TouchdownError, match="k is given 256, and holds whole numbers from 0 to 255"):
        open_system(alone(probe, set={"k": 256}))


@pytest.mark.parametrize(
    ("dtype", "least", "beyond"),
    [("i8", -(2.0**63), 2.0**63), ("u8", 0.0, 2.0**64), ("i4", -(2.0**31), 2.0**31), ("u1", 0.0, np.nan)],
)
def test_no_type_is_given_more_than_it_holds(dtype: str, least: float, beyond: float, probe: Path) -> None:
    data = np.zeros(2, dtype)
    with opened(alone(probe)) as system:
        put = partial(put_values, system.components["probe"], ("n", "big", "k"), np.array([0, 2]))
        put(np.array([least, 1.0]), data)
        assert data.tolist() == [least, 1]
        with pytest.raises(TouchdownError, match="k is given"):
            put(np.array([least, beyond]), data)


def test_booleans_and_choices_are_recorded_and_cross(fed: Path, tmp_path: Path) -> None:
    """A choice to its like and to a whole number, which keep their starts until they are told."""
    ends = ("one.on", "other.heard"), ("one.choice", "other.chosen"), ("one.choice", "other.k")
    scene = two(fed, "on", "heard", 6).set({"*.isolate": False})
    scene = replace(scene, connect=tuple(Wire(output, given) for output, given in ends))
    scene = scene.set({"run.record_every": 1})
    _, heard, _ = history(scene, ["other.heard", "other.chosen", "other.k"], in_process=False)
    run_scene(scene, tmp_path / "out")
    values, odd = recorded(tmp_path / "out"), np.arange(7) % 2
    assert np.array_equal(values["one/on"], odd)
    assert np.array_equal(values["one/choice"], 2 + odd)
    assert np.array_equal(heard["other.heard"], odd[1:])
    assert np.array_equal(heard["other.chosen"], 2 + odd[1:])
    assert np.array_equal(heard["other.k"], 2 + odd[1:])


def test_a_step_that_ends_early_is_said(probe: Path) -> None:
    scene = alone(probe).set({"run.duration": 2.0})
    with opened(scene) as system:
        reason = simulate(scene, system).reason
    assert reason == "component probe: its FMU returned early at t = 1 s"


def test_what_is_no_number_is_refused(probe: Path, tmp_path: Path) -> None:
    with (
        pytest.raises(TouchdownError, match=r"probe\.raw .*Binary"),
        opened(alone(probe, set={"raw": 1.0})),
    ):
        pass
    with pytest.raises(TouchdownError, match=r"component probe is FMI 3\.0; SSP 1\.0 packages"):
        write_ssp(alone(probe), tmp_path / "probe.ssp")


def test_types_that_fmi_3_does_not_have_are_named(probe: Path, tmp_path: Path) -> None:
    """Also those of FMI 2.0."""
    path = saying(probe, tmp_path / "scheduled.fmu", "<CoSimulation", "<ScheduledExecution")
    with pytest.raises(TouchdownError, match=r"scheduled execution only; FMI 2\.0 or 3\.0"):
        check_fmu(str(path))
