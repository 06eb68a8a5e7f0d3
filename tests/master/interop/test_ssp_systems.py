"""SSP packages as other tools write them: systems in systems, their connectors, SSP 2.0, masters' steps."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import pytest
from archives import archive

from touchdown.fmus.build import cached_fmu
from touchdown.fmus.recipes import recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.xml import NAMESPACES, SSD_FILE
from touchdown.master.scene.scene import Scene

ROOT = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())
UNITS = """<ssd:Units>
<ssc:Unit name="mm"><ssc:BaseUnit m="1" factor="0.001"/></ssc:Unit>
<ssc:Unit name="m"><ssc:BaseUnit m="1"/></ssc:Unit>
<ssc:Unit name="rpm"><ssc:BaseUnit rad="1" s="-1" factor="0.10471975511965977"/></ssc:Unit>
</ssd:Units>"""


def connector(name: str, kind: str, unit: str = "", real: str = "Real") -> str:
    stated = f' unit="{unit}"' if unit else ""
    return f'<ssd:Connector name="{name}" kind="{kind}"><ssc:{real}{stated}/></ssd:Connector>'


def connection(start: str, end: str, inside: str = "") -> str:
    """Of ELEMENT:CONNECTOR, or CONNECTOR of the system itself."""
    ends = ""
    for key, text in (("start", start), ("end", end)):
        element, _, name = text.rpartition(":")
        ends += f' {key}Element="{element}"'  # some tools leave it out, others empty
        ends += f' {key}Connector="{name}"'
    return f"<ssd:Connection{ends}>{inside}</ssd:Connection>"


def bound(real: str = "Real", mapping: str = "", **values: str) -> str:
    """Parameter bindings with these values; __ in a name is a dot."""
    parameters = "".join(
        f'<ssv:Parameter name="{name.replace("__", ".")}"><ssv:{real} {given}/></ssv:Parameter>'
        for name, given in values.items()
    )
    return (
        "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
        f'<ssv:ParameterSet version="1.0" name="values"><ssv:Parameters>{parameters}</ssv:Parameters>'
        f"</ssv:ParameterSet></ssd:ParameterValues>{mapping}</ssd:ParameterBinding></ssd:ParameterBindings>"
    )


def system(name: str, elements: str, connections: str, connectors: str = "", bindings: str = "") -> str:
    return (
        f'<ssd:System name="{name}"><ssd:Connectors>{connectors}</ssd:Connectors>{bindings}'
        f"<ssd:Elements>{elements}</ssd:Elements><ssd:Connections>{connections}</ssd:Connections></ssd:System>"
    )


def component(name: str, fmu: str, more: str = "") -> str:
    return f'<ssd:Component name="{name}" source="resources/{fmu}.fmu">{more}</ssd:Component>'


SHAFT = system(
    "shaft.line",
    component("rotor", "rigid_rotor", bound(mass='value="2"')),
    connection("rotor:A.x", "x")
    + connection("height", "rotor:A.y")  # ends may stand in either order
    + connection("fx", "rotor:A.fx")
    + connection("fy", "rotor:A.fy")
    + connection("at", "rotor:y"),
    connector("x", "output", "mm")
    + connector("height", "output")
    + connector("fx", "input")
    + connector("fy", "input")
    + connector("at", "parameter", "mm"),
    bound(rotor__gravity='value="1"', rotor__mass='value="3"'),
)
WHOLE = system(
    "whole",
    SHAFT + component("bearing", "bushing"),
    connection("shaft.line:x", "bearing:journal.x", '<ssc:LinearTransformation offset="1.0"/>')
    + connection("shaft.line:height", "bearing:journal.y")
    + connection("bearing:journal.fx", "shaft.line:fx")
    + connection("bearing:journal.fy", "shaft.line:fy")
    + connection("start", "shaft.line:at")
    + connection("spin", "bearing:journal.omega"),
    connector("start", "parameter", "m")
    + connector("spin", "input", "rpm")
    + connector("nowhere", "parameter")
    + connector("open", "input"),
    bound(
        start='value="-0.25" unit="mm"',
        nowhere='value="7"',
        **{"shaft.line__rotor__gravity": 'value="1.62"'},
    ),
)
Pack = Callable[..., Scene]
USED = ("rigid_rotor", "bushing")


@pytest.fixture
def pack(tmp_path: Path) -> Pack:
    def make(
        whole: str = WHOLE, version: str = "1.0", more: str = UNITS, times: str = 'stopTime="0.004"'
    ) -> Scene:
        """The scene that a package of the system is read as."""
        text = f"""<ssd:SystemStructureDescription {ROOT} version="{version}" name="others">{whole}{more}
            <ssd:DefaultExperiment {times}/></ssd:SystemStructureDescription>"""
        fmus = {f"resources/{name}.fmu": cached_fmu(recipe(name)).read_bytes() for name in USED}
        return find_scene(str(archive(tmp_path / "others.ssp", {SSD_FILE: text, **fmus})))

    return make


def test_systems_in_systems_are_flattened(pack: Pack) -> None:
    """Names are joined, ports recognised, values of outer systems above those of inner ones."""
    scene = pack()
    assert list(scene.components) == ["bearing", "shaft_line_rotor"]
    shaft = {"mass": 3.0, "gravity": 1.62, "y": -0.25e-3}
    assert scene.components["shaft_line_rotor"].set == pytest.approx(shaft)
    wires = {(w.source, w.target): w.scale for w in scene.connect}
    assert set(wires) == {
        ("shaft_line_rotor.A.x", "bearing.journal.x"),
        ("shaft_line_rotor.A.y", "bearing.journal.y"),
        ("bearing.journal.fx", "shaft_line_rotor.A.fx"),
        ("bearing.journal.fy", "shaft_line_rotor.A.fy"),
    }
    assert wires["shaft_line_rotor.A.x", "bearing.journal.x"] == pytest.approx((1.0, 1.0))  # m to mm to m
    assert wires["shaft_line_rotor.A.y", "bearing.journal.y"] is None
    with opened(scene) as system:
        assert system.order == ["bearing", "shaft_line_rotor"]


def test_a_value_on_a_connector_of_the_system_is_converted_on_its_way(pack: Pack) -> None:
    given = WHOLE.replace('name="start"><ssv', 'name="spin"><ssv')
    given = given.replace('value="-0.25" unit="mm"', 'value="60"')
    assert given != WHOLE
    spun = pack(given).components["bearing"].set
    assert spun == pytest.approx({"journal.omega": 60 * 0.10471975511965977})


@pytest.mark.parametrize("inside", ["", '<ssm:ParameterMapping version="1.0"/>'])
def test_an_empty_mapping_leaves_names_as_they_are(inside: str, pack: Pack) -> None:
    mapping = f"<ssd:ParameterMapping>{inside}</ssd:ParameterMapping>"
    whole = system("w", component("rotor", "rigid_rotor", bound(mapping=mapping, mass='value="2"')), "")
    assert pack(whole).components["rotor"].set == {"mass": 2.0}


def test_entries_of_a_template_map_nothing(pack: Pack) -> None:
    entries = '<ssm:MappingEntry source="" target="speed"/><ssm:MappingEntry source="m" target="mass"/>'
    mapping = f'<ssm:ParameterMapping version="1.0">{entries}</ssm:ParameterMapping>'
    values = bound(mapping=f"<ssd:ParameterMapping>{mapping}</ssd:ParameterMapping>", m='value="2"')
    whole = system("w", component("rotor", "rigid_rotor", values), "")
    assert pack(whole).components["rotor"].set == {"mass": 2.0}


def test_ssp_2_is_read_with_types_of_fmi_3(pack: Pack) -> None:
    typed = bound("Float64", mass='value="2"').replace("1.0", "2.0")
    spin = connector("spin", "input", "rpm", "Float64")
    whole = system("w", component("rotor", "rigid_rotor", typed), "", spin)
    assert pack(whole, "2.0").components["rotor"].set == {"mass": 2.0}


@pytest.mark.parametrize(
    ("told", "step"),
    [
        ('<oms:SimulationInformation><oms:FixedStepMaster description="oms-ma" stepSize="1e-4"/>', 1e-4),
        ('<oms:SimulationInformation name="m" method="oms_ma" fixedStepSize="2e-4">', 2e-4),
        ("<oms:SimulationInformation>", 2e-5),
    ],
)
def test_omsimulators_step_is_taken(told: str, step: float, pack: Pack) -> None:
    annotation = (
        '<ssd:Annotations><ssc:Annotation type="org.openmodelica"><oms:Annotations>'
        f"{told}</oms:SimulationInformation></oms:Annotations></ssc:Annotation></ssd:Annotations></ssd:System>"
    )
    whole = system("w", component("rotor", "rigid_rotor"), "").replace("</ssd:System>", annotation)
    assert pack(whole).run.macro_step == step


@pytest.mark.parametrize(("stop", "duration"), [('stopTime="10.004"', 0.004), ("", 1.0)])
def test_the_start_time_is_taken(stop: str, duration: float, pack: Pack) -> None:
    """Without a stop time a run is as long as one of a scene that says nothing."""
    run = pack(times=f'startTime="10" {stop}').run
    assert (run.start_time, run.duration) == (10.0, duration)


def test_a_binding_for_nothing_is_named_with_its_system(pack: Pack) -> None:
    (line,) = pack(WHOLE.replace('name="rotor.gravity"', 'name="router.gravity"')).remarks
    assert "are ignored (1): shaft.line.router.gravity" in line


def passing(name: str) -> str:
    """A system that only passes a value on."""
    return system(name, "", connection("i", "o"), connector("i", "input") + connector("o", "output"))


def lattice(layers: int) -> str:
    """Layers of two systems, each fed by both of the layer before: ways double with each."""
    names = [(f"p{i}", f"q{i}") for i in range(layers)]
    joined = "".join(
        connection(f"{one}:o", f"{other}:i")
        for before, after in itertools.pairwise(names)
        for one in before
        for other in after
    )
    ends = [connection("rotor:A.x", f"{first}:i") for first in names[0]]
    ends += [connection(f"{last}:o", "bearing:journal.x") for last in names[-1]]
    inside = component("rotor", "rigid_rotor") + component("bearing", "bushing")
    return system(
        "w", inside + "".join(passing(name) for pair in names for name in pair), joined + "".join(ends)
    )


def chain(length: int) -> str:
    names = ["rotor:A.x", *(f"p{i}:{end}" for i in range(length) for end in "io"), "bearing:journal.x"]
    inside = component("rotor", "rigid_rotor") + component("bearing", "bushing")
    joined = "".join(connection(*pair) for pair in zip(names[::2], names[1::2], strict=True))
    return system("w", inside + "".join(passing(f"p{i}") for i in range(length)), joined)


def nested(depth: int) -> str:
    return component("rotor", "rigid_rotor") if depth == 0 else system("n", nested(depth - 1), "")


@pytest.mark.parametrize(
    ("whole", "says"),
    [
        (lattice(30), "by two ways"),
        (chain(200), "over more than 100 connections"),
        (nested(150), "more than 200 deep in each other"),
    ],
    ids=["lattice", "chain", "nested"],
)
def test_ways_without_end_are_refused(whole: str, says: str, pack: Pack) -> None:
    with pytest.raises(TouchdownError, match=says):
        pack(whole)


def test_a_long_way_is_followed(pack: Pack) -> None:
    wires = pack(chain(40)).connect
    assert [(wire.source, wire.target) for wire in wires] == [("rotor.A.x", "bearing.journal.x")]
