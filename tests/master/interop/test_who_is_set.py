"""Who may be set, by scenes and by packages, and who wins: the rows of the table in docs/systems.md."""

from __future__ import annotations

from pathlib import Path

import h5py
import pytest
from archives import archive, entries_of, saying
from pythonfmu import FmuBuilder
from systems import recorded

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.description import interface
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.interop.ssp.xml import NAMESPACES, SSD_FILE
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

SOURCE = '''
from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real, String


class Mass(Fmi2Slave):
    """A mass that is let go, and the length of a file's name."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.x, self.v, self.held, self.k, self.seen, self.letters = 1e-3, 0.0, 5.0, 1.0, 0.0, 0.0
        self.pi, self.file, self.push = 3.14, "default.txt", 0.0
        out, exact = Fmi2Causality.output, Fmi2Initial.exact
        parameter = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(Real("x", start=1e-3, causality=out, initial=exact))
        self.register_variable(
            Real("v", start=0.0, causality=Fmi2Causality.local, initial=Fmi2Initial.approx)
        )
        self.register_variable(Real("held", causality=out, initial=Fmi2Initial.calculated))
        self.register_variable(Real("k", start=1.0, **parameter))
        self.register_variable(Real("push", start=0.0, causality=Fmi2Causality.input))
        self.register_variable(
            Real(
                "pi",
                start=3.14,
                causality=Fmi2Causality.local,
                variability=Fmi2Variability.constant,
                initial=exact,
            )
        )
        self.register_variable(String("file", start="default.txt", **parameter))
        self.register_variable(Real("seen", causality=out))
        self.register_variable(Real("letters", causality=out))

    def exit_initialization_mode(self):
        self.seen, self.letters = self.k, float(len(self.file))

    def do_step(self, current_time, step_size):
        self.x += self.v * step_size
        return True
'''
ROOT = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())
UNITS = (
    '<ssv:Units><ssc:Unit name="[mm]"><ssc:BaseUnit m="1" factor="0.001"/></ssc:Unit>'
    '<ssc:Unit name="m"><ssc:BaseUnit m="1"/></ssc:Unit></ssv:Units>'
)


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An FMU of SOURCE, whose k is measured in metres, as a tool writes them that puts brackets around."""
    folder = tmp_path_factory.mktemp("mass")
    script = folder / "mass.py"
    script.write_text(SOURCE)
    made = FmuBuilder.build_FMU(script, dest=folder)
    plain = entries_of(made)["modelDescription.xml"].decode()
    k, after = plain.index("<Real", plain.index('name="k"')), plain.index("<LogCategories")
    units = '<UnitDefinitions><Unit name="[m]"><BaseUnit m="1"/></Unit></UnitDefinitions>'
    changed = f'{plain[:after]}{units}{plain[after:k]}<Real unit="[m]"{plain[k + 5 :]}'
    (folder / "measured").mkdir()
    return saying(made, folder / "measured" / "mass.fmu", plain, changed)


def scene_of(fmu: Path, settings: str) -> Scene:
    """The mass alone, set as the lines of a table say."""
    path = fmu.with_name("scene.toml")
    run = '[run]\nduration = "2 ms"\nmacro_step = "1 ms"\nrecord_every = 1\n'
    path.write_text(f'{run}[components.mass]\nfmu = "mass.fmu"\n[components.mass.set]\n{settings}')
    return load_scene(str(path))


def binding(**values: str) -> str:
    """Parameter bindings; __ in a name is a dot, a value is the inside of an element of its type."""
    parameters = "".join(
        f'<ssv:Parameter name="{name.replace("__", ".")}"><ssv:{value}/></ssv:Parameter>'
        for name, value in values.items()
    )
    return (
        "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues><ssv:ParameterSet "
        f'version="1.0" name="set"><ssv:Parameters>{parameters}</ssv:Parameters>{UNITS}</ssv:ParameterSet>'
        "</ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
    )


def real(value: str, unit: str = "") -> str:
    return f'Real value="{value}"' + (f' unit="{unit}"' if unit else "")


def package(fmu: Path, folder: Path, inside: str = "", system: str = "", more: str = "") -> Scene:
    """The scene of a package with the mass; bindings of it and of the system, and connections."""
    text = f"""<ssd:SystemStructureDescription {ROOT} version="1.0" name="one"><ssd:System name="root">
<ssd:Connectors><ssd:Connector name="length" kind="parameter"><ssc:Real/></ssd:Connector></ssd:Connectors>
{system}<ssd:Elements><ssd:Component name="mass" source="resources/mass.fmu">{inside}</ssd:Component>
</ssd:Elements>{more}</ssd:System>
<ssd:DefaultExperiment stopTime="0.002"/></ssd:SystemStructureDescription>"""
    files = {SSD_FILE: text, "resources/mass.fmu": fmu.read_bytes()}
    scene = find_scene(str(archive(folder / "one.ssp", files)))
    return scene.set({"run.macro_step": 1e-3, "run.record_every": 1})


def test_states_and_outputs_with_a_start_value_are_set(fmu: Path, tmp_path: Path) -> None:
    from_file = scene_of(fmu, "x = 2e-3\nv = 0.5")
    from_package = package(fmu, tmp_path, binding(x=real("0.002"), v=real("0.5")))
    for number, scene in enumerate((from_file, from_package)):
        run_scene(scene, tmp_path / str(number))
        x = recorded(tmp_path / str(number))["mass/x"]
        assert x == pytest.approx([2e-3, 2.5e-3, 3e-3])
    with pytest.raises(TouchdownError, match=r"mass\.held has the causality output \(constant, or initial"):
        run_scene(scene_of(fmu, "held = 1"), tmp_path / "no")
    with pytest.raises(TouchdownError, match=r"mass\.pi has the causality local"):
        run_scene(scene_of(fmu, "pi = 3"), tmp_path / "no")


def test_texts_are_set_and_kept_with_the_recording(fmu: Path, tmp_path: Path) -> None:
    text = "measured and größer.txt"
    from_package = package(fmu, tmp_path, binding(file=f'String value="{text}"'))
    again = write_ssp(from_package, tmp_path / "again.ssp").path
    run = {"run.record_every": 1}
    for number, scene in enumerate(
        (scene_of(fmu, f'file = "{text}"'), from_package, find_scene(str(again)).set(run))
    ):
        result = run_scene(scene, tmp_path / str(number))
        assert recorded(tmp_path / str(number))["mass/letters"][-1] == len(text)
        assert result.data.attrs["mass.file"] == text
        assert h5py.File(tmp_path / str(number) / "result.h5").attrs["mass.file"] == text
    assert not check_fmu(str(fmu)).problems
    with pytest.raises(TouchdownError, match=r"mass\.file = 5 must be text"):
        run_scene(scene_of(fmu, "file = 5"), tmp_path / "no")


def test_surplus_values_of_a_package_are_ignored_with_one_line(fmu: Path, tmp_path: Path) -> None:
    values = {
        "mass__k": real("2"),
        "mass__wear": real("1"),
        "seal__gap": real("NaN"),
        "mass__pi": real("3"),
    }
    scene = package(fmu, tmp_path, system=binding(**values))
    assert scene.components["mass"].set == {"k": 2.0}
    (line,) = run_scene(scene, tmp_path / "out").warnings
    assert "are ignored (3): " in line
    assert all(name in line for name in ("mass.wear", "seal.gap", "mass.pi"))
    with pytest.raises(TouchdownError, match=r"mass, k = inf is not a finite number"):
        package(fmu, tmp_path, binding(k=real("INF")))
    with pytest.raises(TouchdownError, match="has no variable wear"):
        run_scene(scene_of(fmu, "wear = 1"), tmp_path / "no")


@pytest.mark.parametrize("connector_first", [True, False])
def test_what_comes_through_a_connection_wins(connector_first: bool, fmu: Path, tmp_path: Path) -> None:
    """Over values for the same parameter in the same set, in either order, and in its component."""
    more = (
        '<ssd:Connections><ssd:Connection startConnector="length" endElement="mass" endConnector="k"/>'
        "</ssd:Connections>"
    )
    both = [("length", real("3")), ("mass__k", real("2"))]
    system = binding(**dict(both if connector_first else reversed(both)))
    scene = package(fmu, tmp_path, binding(k=real("1.5")), system, more)
    assert scene.components["mass"].set == {"k": 3.0}
    (line,) = scene.remarks
    assert "overridden by what comes along connections (1): mass.k" in line


def test_an_input_that_is_fed_keeps_to_its_connection(fmu: Path, tmp_path: Path) -> None:
    more = (
        f'</ssd:Component><ssd:Component name="other" source="resources/mass.fmu">{binding(push=real("9"))}'
    )
    wire = (
        '<ssd:Connections><ssd:Connection startElement="mass" startConnector="held" endElement="other" '
        'endConnector="push"/></ssd:Connections>'
    )
    scene = package(fmu, tmp_path, more, more=wire)
    assert (scene.components["other"].set, scene.remarks) == ({}, ())
    with pytest.raises(TouchdownError, match=r"other\.push cannot be set: it is connected to mass\.held"):
        run_scene(scene.set({"other.push": 9.0}), tmp_path / "out")


def test_the_outer_and_the_later_binding_win_without_a_word(fmu: Path, tmp_path: Path) -> None:
    later = binding(k=real("1")) + binding(k=real("2"))
    later = later.replace("</ssd:ParameterBindings><ssd:ParameterBindings>", "")
    scene = package(fmu, tmp_path, later)
    assert (scene.components["mass"].set, scene.remarks) == ({"k": 2.0}, ())
    scene = package(fmu, tmp_path, later, binding(mass__k=real("4")))
    assert (scene.components["mass"].set, scene.remarks) == ({"k": 4.0}, ())


def test_units_may_stand_in_brackets(fmu: Path, tmp_path: Path) -> None:
    variables, units, _ = interface(fmu, tmp_path / "cache")
    assert variables["k"].unit == "m"
    assert "m" in units
    for number, unit in enumerate(("[mm]", "mm")):
        scene = package(fmu, tmp_path, binding(k=real("20", unit)))
        run_scene(scene, tmp_path / str(number))
        assert recorded(tmp_path / str(number))["mass/seen"][-1] == pytest.approx(0.02, rel=1e-12)
    run_scene(scene_of(fmu, 'k = "20 mm"'), tmp_path / "file")
    assert recorded(tmp_path / "file")["mass/seen"][-1] == pytest.approx(0.02, rel=1e-12)


def test_a_list_of_another_length_is_refused(fmu: Path, tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match=r"mass, k takes 1 values; 2 are given"):
        package(fmu, tmp_path, binding(k=real("1 2")))
    with pytest.raises(TouchdownError, match=r"has no variable a"):
        run_scene(scene_of(fmu, "a = [1, 2]"), tmp_path / "no")


def test_a_name_that_several_have_sets_them_all(fmu: Path, tmp_path: Path) -> None:
    """A component's name may hold a dot: then two variables can have one name in a system."""
    more = '</ssd:Component><ssd:Component name="mass.k" source="resources/mass.fmu">'
    scene = package(fmu, tmp_path, more, binding(mass__k__k=real("4"), mass__k=real("2")))
    assert [spec.set for spec in scene.components.values()] == [{"k": 2.0}, {"k": 4.0}]
    assert scene.remarks == ()


def test_variants_are_listed_and_chosen_by_either_name(
    fmu: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    package(fmu, tmp_path, binding(k=real("2")))
    files = entries_of(tmp_path / "one.ssp")
    heavy = files[SSD_FILE].decode().replace('name="one"', 'name="Heavy one"').replace('"2"', '"9"')
    several = archive(tmp_path / "several.ssp", {**files, "VarB.ssd": heavy, "broken.ssd": "<a"})
    scene = find_scene(str(several))
    assert scene.components["mass"].set == {"k": 2.0}
    assert "--variant takes VarB or broken" in scene.remarks[0]
    for name in ("VarB", "Heavy one"):
        assert touchdown.load(several, variant=name).components["mass"].set == {"k": 9.0}
    out = str(tmp_path / "out")
    assert main(["run", str(several), "--variant", "VarB", "-o", out, "--no-pictures", "--quiet"]) == 0
    assert recorded(tmp_path / "out")["mass/seen"][-1] == 9.0
    assert "variants" not in capsys.readouterr().err
    with pytest.raises(TouchdownError, match=r"has no variant VarC; did you mean VarB"):
        find_scene(str(several), "VarC")
    with pytest.raises(TouchdownError, match=r"has no variants"):
        find_scene("disk-caged-simplified", "VarB")
