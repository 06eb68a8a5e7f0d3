"""SSP packages: valid, equal to the byte, and run as the scene they were made of, to the last bit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import fmpy.ssp
import numpy as np
import pytest
from archives import archive, entries_of
from fmpy.ssp.ssd import read_ssd
from lxml import etree
from systems import history

from touchdown.fmus.build import cached_fmu
from touchdown.fmus.recipes import recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import open_system
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.interop.ssp.xml import CHOICES, NAMESPACES, SSD_FILE
from touchdown.master.scene.file import parse_scene
from touchdown.master.scene.scene import Scene

SCHEMAS = Path(fmpy.ssp.__file__).parent / "schema"
START = {"amb.shutdown_time": 10.0, "run.start_time": "10 s"}
DROP = {**START, "run.duration": 0.012, "run.macro_step": 1e-4, "run.scheme": "interface"}
WATCHED = ["rotor.A.x", "rotor.A.y", "bearing.journal.fx", "bearing.contact.peak_force", "housing.seat.y"]


def dropped() -> Scene:
    """A disk that drops at once and hits its bearing within the run."""
    return find_scene("disk-caged-simplified").set(DROP)


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_ssp(dropped(), tmp_path_factory.mktemp("ssp") / "disk.ssp").path


def structure(path: Path) -> etree._Element:
    return etree.fromstring(entries_of(path)[SSD_FILE])


# -- written -----------------------------------------------------------------------------------------------


def test_a_package_is_valid(package: Path) -> None:
    assert read_ssd(str(package)).name == "disk_caged_simplified"  # validates the structure
    schema = etree.XMLSchema(file=str(SCHEMAS / "SystemStructureParameterValues.xsd"))
    sets = structure(package).findall(".//ssv:ParameterSet", NAMESPACES)
    assert len(sets) == 4
    for one in sets:
        schema.assertValid(etree.fromstring(etree.tostring(one)))
    root = structure(package)
    defined = {unit.get("name") for unit in root.findall("ssd:Units/ssc:Unit", NAMESPACES)}
    used = {element.get("unit") for element in root.iter() if element.get("unit")}
    assert {"m", "N", "rad/s", "1/kg"} <= used <= defined


def test_equal_scenes_give_equal_bytes(package: Path, tmp_path: Path) -> None:
    again = write_ssp(dropped(), tmp_path / "elsewhere" / "again.ssp").path
    assert again.read_bytes() == package.read_bytes()


def test_connections_are_those_of_the_scheme(tmp_path: Path) -> None:
    """Of a flexible rotor's modes those in use, sensors and constants among them."""
    scene = find_scene("rotor1-9000").set({"rotor.modes": 2, "run.duration": 1e-3})
    path = write_ssp(scene, tmp_path / "rotor.ssp").path
    system = open_system(scene, in_process=True)
    try:
        system.initialise()
        laid_out = [(c.source, c.output, c.target, c.input) for c in system.connections]
    finally:
        system.close()
    ends = ("startElement", "startConnector", "endElement", "endConnector")
    found = structure(path).findall("ssd:System/ssd:Connections/ssd:Connection", NAMESPACES)
    assert [tuple(c.get(end) for end in ends) for c in found] == laid_out
    assert ("rotor", "A.mode[2].inv_m", "bearing_A", "journal.mode[2].inv_m") in laid_out
    assert not any("mode[3]" in output for _, output, _, _ in laid_out)
    assert ("rotor", "sensor_A.x", "amb_A", "sensor.x") in laid_out


def test_constants_are_start_values_too(package: Path) -> None:
    """Not every tool hands them over during initialisation."""
    values = {
        parameter.get("name"): float(parameter[0].get("value", ""))
        for parameter in structure(package).findall(
            ".//ssd:Component[@name='bearing']//ssv:Parameter", NAMESPACES
        )
    }
    assert values["journal.inv_m"] == pytest.approx(1.0 / 1.65, rel=1e-12)
    assert values["journal.omega"] == pytest.approx(942.4777960769379, rel=1e-12)


# -- read --------------------------------------------------------------------------------------------------


def test_a_package_runs_as_its_scene_to_the_last_bit(package: Path) -> None:
    scene, again = dropped(), find_scene(str(package))
    assert (again.run, again.zero, again.energy_scale) == (scene.run, scene.zero, scene.energy_scale)
    times, values, outcome = history(scene, WATCHED, in_process=False)
    times_again, values_again, outcome_again = history(again, WATCHED, in_process=False)
    assert values["bearing.contact.peak_force"][-1] > 100.0
    assert np.array_equal(times, times_again)
    for name in WATCHED:
        assert np.array_equal(values[name], values_again[name]), name
    assert outcome.residual == outcome_again.residual > 0.0


def test_units_and_types_survive(package: Path, tmp_path: Path) -> None:
    again = write_ssp(find_scene(str(package)), tmp_path / "disk.ssp").path
    assert structure(again).get("name") == "disk"
    parts = "ssd:System/ssd:Elements", "ssd:System/ssd:Connections", "ssd:Units", "ssd:DefaultExperiment"
    for part in parts:
        first, second = (structure(path).find(part, NAMESPACES) for path in (package, again))
        assert sorted(map(_plain, first.iter())) == sorted(map(_plain, second.iter())), part


def _plain(element: etree._Element) -> tuple[object, ...]:
    return element.tag, sorted(element.attrib.items())


def test_macro_steps_of_their_own_and_scales_survive(tmp_path: Path) -> None:
    """Every second step for a component; a sensor that reads twice the height and 1 um."""
    scene = parse_scene(
        {
            "components": {
                "rotor": {"fmu": "rigid_rotor", "set": {"y": "10 um"}},
                "amb": {"fmu": "amb", "every": 2},
            },
            "attach": [["amb.journal", "rotor.amb"]],
            "connect": [["rotor.A.y", "amb.sensor.y", 2.0, 1e-6]],
            "run": {"duration": 1e-3},
        },
        "scaled",
        tmp_path,
    )
    again = find_scene(str(write_ssp(scene, tmp_path / "scaled.ssp").path))
    assert again.components["amb"].every == 2
    assert again.connect[-1] == scene.connect[0]
    times, values, _ = history(again, ["rotor.A.y", "amb.sensor.y"], in_process=False)
    assert len(times) > 10
    before = values["rotor.A.y"][np.arange(len(times)) // 2 * 2 - 1][2:]
    assert len(np.unique(before)) > 10
    assert np.array_equal(values["amb.sensor.y"][2:], 2.0 * before + 1e-6)


# -- of other tools ----------------------------------------------------------------------------------------

ROOT = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())
CONNECTED = [
    ("rotor", "A.x", "bearing", "journal.x"),
    ("rotor", "A.y", "bearing", "journal.y"),
    ("bearing", "journal.fx", "rotor", "A.fx"),
    ("bearing", "journal.fy", "rotor", "A.fy"),
]
SSV = f"""<ssv:ParameterSet {ROOT} version="1.0" name="rotor"><ssv:Parameters>
<ssv:Parameter name="weight"><ssv:Real value="1650" unit="g"/></ssv:Parameter>
<ssv:Parameter name="start"><ssv:Real value="-0.25" unit="mm"/></ssv:Parameter>
<ssv:Parameter name="ignored"><ssv:Real value="1"/></ssv:Parameter>
</ssv:Parameters><ssv:Units>
<ssc:Unit name="g"><ssc:BaseUnit kg="1" factor="0.001"/></ssc:Unit>
<ssc:Unit name="mm"><ssc:BaseUnit m="1" factor="0.001"/></ssc:Unit>
</ssv:Units></ssv:ParameterSet>"""
SSM = f"""<ssm:ParameterMapping {ROOT} version="1.0">
<ssm:MappingEntry source="weight" target="mass"/>
<ssm:MappingEntry source="start" target="y"><ssc:LinearTransformation factor="0.5"/></ssm:MappingEntry>
</ssm:ParameterMapping>"""
BOUND = """<ssd:ParameterBindings><ssd:ParameterBinding source="parameters/rotor.ssv">
<ssd:ParameterMapping source="parameters/rotor.ssm"/></ssd:ParameterBinding></ssd:ParameterBindings>"""
SYSTEM_VALUES = """<ssd:ParameterBindings><ssd:ParameterBinding prefix="rotor."><ssd:ParameterValues>
<ssv:ParameterSet version="1.0" name="outer"><ssv:Parameters>
<ssv:Parameter name="gravity"><ssv:Real value="1.62"/></ssv:Parameter>
</ssv:Parameters></ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"""


def foreign(
    connections: str = "", elements: str = "", system: str = SYSTEM_VALUES, bound: str = BOUND
) -> str:
    """A structure as another tool may write it: a rotor on a bushing, parameters in files of their own."""
    wires = "".join(
        f'<ssd:Connection startElement="{a}" startConnector="{b}" endElement="{c}" endConnector="{d}"/>'
        for a, b, c, d in CONNECTED
    )
    return f"""<ssd:SystemStructureDescription {ROOT} version="1.0" name="foreign">
<ssd:System name="whole">{system}<ssd:Elements>
<ssd:Component name="rotor" source="resources/rigid%5Frotor.fmu">{bound}</ssd:Component>
<ssd:Component name="bearing" source="resources/bushing.fmu"/>{elements}
</ssd:Elements><ssd:Connections>{wires}{connections}</ssd:Connections></ssd:System>
<ssd:DefaultExperiment stopTime="0.004"/></ssd:SystemStructureDescription>"""


Pack = Callable[..., Path]


@pytest.fixture
def pack(tmp_path: Path) -> Pack:
    def make(text: str | None, **more: str) -> Path:
        """A package of `text` and FMUs, with files changed as `more` says."""
        files = {
            SSD_FILE: foreign() if text is None else text,
            "parameters/rotor.ssv": more.get("ssv", SSV),
            "parameters/rotor.ssm": more.get("ssm", SSM),
            "resources/rigid_rotor.fmu": cached_fmu(recipe("rigid_rotor")).read_bytes(),
            "resources/bushing.fmu": cached_fmu(recipe("bushing")).read_bytes(),
        }
        return archive(tmp_path / "foreign.ssp", files)

    return make


def test_bindings_mappings_and_units_of_other_tools_are_applied(pack: Pack) -> None:
    scene = find_scene(str(pack(None)))
    assert scene.components["rotor"].set == pytest.approx({"mass": 1.65, "y": -0.125e-3, "gravity": 1.62})
    assert scene.run.duration == 0.004
    system = open_system(scene)
    try:
        assert [a.title for a in system.attachments] == ["bearing.journal on rotor.A"]
        assert system.order == ["bearing", "rotor"]
    finally:
        system.close()


def friction(pack: Pack, value: str) -> Scene:
    """The foreign package with a bushing whose law of friction a parameter set names."""
    inside = f"""<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>
<ssv:ParameterSet version="1.0" name="law"><ssv:Parameters><ssv:Parameter name="friction.kind">{value}
</ssv:Parameter></ssv:Parameters></ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding>
</ssd:ParameterBindings>"""
    bushing = 'source="resources/bushing.fmu"'
    return find_scene(str(pack(foreign().replace(f"{bushing}/>", f"{bushing}>{inside}</ssd:Component>"))))


def test_enumerations_are_set_by_their_words(pack: Pack) -> None:
    scene = friction(pack, '<ssv:Enumeration value="coulomb" name="FrictionLaw"/>')
    assert scene.components["bearing"].set == {"friction.kind": "coulomb"}
    brief = {"run.duration": 4e-5, "run.macro_step": 2e-5}
    _, values, _ = history(scene.set(brief), ["bearing.friction.kind"], in_process=False)
    assert set(values["bearing.friction.kind"]) == {0.0}
    with pytest.raises(TouchdownError, match="not one of its choices: coulomb"):
        open_system(friction(pack, '<ssv:Enumeration value="dry"/>'))


def test_the_outer_binding_wins(pack: Pack) -> None:
    outer = SYSTEM_VALUES.replace('"gravity"', '"mass"')
    assert find_scene(str(pack(foreign(system=outer)))).components["rotor"].set["mass"] == 1.62


def test_a_connection_is_converted_and_transformed(pack: Pack) -> None:
    """rad/s to revolutions per minute by the connectors' units, then doubled and moved."""
    wire = (
        '<ssd:Connection startElement="rotor" startConnector="A.omega" endElement="bearing" '
        'endConnector="journal.omega"><ssc:LinearTransformation factor="2" offset="3"/></ssd:Connection>'
    )
    scene = find_scene(str(pack(foreign(wire))))
    assert scene.connect[-1].scale == (2.0, 3.0)
    settings = {"rotor.speed": 100.0, "run.duration": 4e-5, "run.macro_step": 2e-5}
    _, values, _ = history(scene.set(settings), ["bearing.journal.omega"], in_process=False)
    assert values["bearing.journal.omega"][-1] == pytest.approx(203.0, abs=1e-6)

    units = (
        '<ssd:Units><ssc:Unit name="rpm"><ssc:BaseUnit rad="1" s="-1" factor="0.10471975511965977"/>'
        "</ssc:Unit></ssd:Units><ssd:DefaultExperiment"
    )
    declared = (
        'bushing.fmu"><ssd:Connectors><ssd:Connector name="journal.omega" kind="input">'
        '<ssc:Real unit="rpm"/></ssd:Connector></ssd:Connectors></ssd:Component>'
    )
    text = foreign(wire).replace("<ssd:DefaultExperiment", units).replace('bushing.fmu"/>', declared)
    scale = find_scene(str(pack(text))).connect[-1].scale
    assert scale == pytest.approx((2.0 / 0.10471975511965977, 3.0), rel=1e-14)


def wired(output: str, given: str, inside: str = "") -> str:
    """A foreign structure with one more connection from rotor to bearing."""
    return foreign(
        f'<ssd:Connection startElement="rotor" startConnector="{output}" endElement="bearing" '
        f'endConnector="{given}">{inside}</ssd:Connection>'
    )


def changed(old: str, new: str) -> str:
    """A foreign structure with `new` in place of `old`."""
    assert old in foreign()
    return foreign().replace(old, new)


DICTIONARY = '<ssd:SignalDictionaryReference name="bus" dictionary="d"/>'
REFUSED = {
    "has two elements rotor": foreign(elements='<ssd:System name="rotor"/>'),
    "holds the SignalDictionaryReference bus": foreign(elements=DICTIONARY),
    "BooleanMappingTransformation is not": wired(
        "A.omega", "journal.omega", f"<ssc:{CHOICES[0]}Transformation/>"
    ),
    "its FMU has no variable A.spin": wired("A.spin", "journal.omega"),
    "rad/s and m/s do not measure the same": wired("A.omega", "journal.vx"),
    "did you mean bearing": changed('endElement="bearing"', 'endElement="baring"'),
    "the package has no file 'resources/bush.fmu'": changed("bushing.fmu", "bush.fmu"),
    "'../bushing.fmu' is not a file inside": changed("resources/bushing.fmu", "../bushing.fmu"),
    "stops at t = 0.004 s, and starts at t = 1 s": changed("stopTime", 'startTime="1" stopTime'),
    "starts at t = -1 s; a start below 0 s is not": changed("stopTime", 'startTime="-1" stopTime'),
    "stopTime = 'soon' is not a number": changed('"0.004"', '"soon"'),
    "SSP 1.0 or 2.0 is needed": changed('version="1.0" name="foreign"', 'version="3.0" name="foreign"'),
    "it is not valid XML": "<ssd:System",
    "its root is html": "<html/>",
    "the type application/x-ssp-package is not": changed(
        'bushing.fmu"', 'bushing.fmu" type="application/x-ssp-package"'
    ),
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le"])
def test_a_document_type_is_refused_in_every_encoding(encoding: str, tmp_path: Path) -> None:
    text = '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "c">]>' + foreign().partition("?>")[2]
    mark = "\ufeff" if encoding == "utf-16-le" else ""
    path = archive(tmp_path / "foreign.ssp", {SSD_FILE: (mark + text).encode(encoding)})
    with pytest.raises(TouchdownError, match="declares a document type"):
        find_scene(str(path))


@pytest.mark.parametrize("expected", REFUSED)
def test_what_cannot_be_run_is_refused_in_one_line(pack: Pack, expected: str) -> None:
    path = pack(REFUSED[expected])
    with pytest.raises(TouchdownError) as refused:
        find_scene(str(path))
    message = str(refused.value)
    assert expected in message
    assert str(path) in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("ssv", 'unit="g"', 'unit="stone"', "cannot convert stone to kg"),
        ("ssv", '"1650"', '"much"', "'much' is not a number"),
        ("ssv", '<ssv:Real value="1"/>', '<ssv:Text value="a"/>', "has no value of a type of SSP"),
        ("ssv", '<ssv:Real value="1650" unit="g"/>', '<ssv:String value="a"/>', "the variable is a Real"),
        ("ssm", "MappingEntry source", "MappingEntry sorce", "a MappingEntry has no source"),
    ],
)
def test_broken_parameters_are_named(pack: Pack, file: str, old: str, new: str, expected: str) -> None:
    text = {"ssv": SSV, "ssm": SSM}[file]
    assert old in text
    with pytest.raises(TouchdownError, match=expected):
        find_scene(str(pack(None, **{file: text.replace(old, new)})))


def test_broken_archives_are_refused(tmp_path: Path, package: Path) -> None:
    path = tmp_path / "broken.ssp"
    with pytest.raises(TouchdownError, match="there is no file"):
        find_scene(str(path))
    path.write_bytes(package.read_bytes()[:100_000])
    with pytest.raises(TouchdownError, match="damaged or not an SSP package"):
        find_scene(str(path))
    archive(path, {"modelDescription.xml": "<a/>"})
    with pytest.raises(TouchdownError, match=r"it has no SystemStructure\.ssd"):
        find_scene(str(path))
    archive(path, {SSD_FILE: foreign(), "../outside": "x"})
    with pytest.raises(TouchdownError, match="leads out of its folder"):
        find_scene(str(path))
    assert not (tmp_path.parent / "outside").exists()
