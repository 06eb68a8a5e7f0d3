"""One package for every tool: names, annotations, and FMUs that start from its values by themselves."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.ssp.simulation import do_step, instantiate_fmu
from fmpy.ssp.ssd import find_components, get_connections, read_ssd
from hosting import COMPILER
from systems import history

from touchdown.command.cli import main
from touchdown.fmus.build import cached_fmu
from touchdown.fmus.native import compiler
from touchdown.fmus.native.native_build import _kept_as
from touchdown.fmus.recipes import recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import identifiers, write_ssp
from touchdown.master.interop.ssp.xml import NAMESPACES, SSD_FILE
from touchdown.master.scene.file import parse_scene
from touchdown.master.scene.scene import Scene

STEP, STEPS = 1e-4, 110  # s; the disk hits its bearing in the 72nd
WATCHED = ["rotor.A.x", "rotor.A.y", "rotor.A.omega", "bearing.journal.fx", "bearing.journal.fy"]


def dropped(bearing: str = "simplified_caged") -> Scene:
    """A disk, faster and in a narrower bearing than by default, dropped at once."""
    scene = find_scene("disk-caged-simplified").swap(bearing=bearing)
    settings = {"rotor.speed": "12000 rpm", "bearing.clearance": 0.25e-3, "bearing.friction.kind": 0}
    run = {"run.duration": STEPS * STEP, "run.macro_step": STEP, "run.scheme": "jacobi-lead"}
    return scene.set({"amb.shutdown_time": 0.0, **settings, **run})


def stepped_by_fmpy(package: Path, folder: Path) -> dict[str, list[float]]:
    """The package in fmpy's runner, which reads none of its values, but for that runner's first inputs.

    It hands 0 to every input in the first step; here inputs begin as the FMUs have them.
    """
    with zipfile.ZipFile(package) as archive:
        archive.extractall(folder)
    system = read_ssd(str(package)).system
    components, connections = find_components(system), get_connections(system)
    for component in components:
        instantiate_fmu(component, str(folder), 0.0)
        described = read_model_description(component.unzipdir, validate=False).modelVariables
        starts = {variable.name: variable.start for variable in described}
        for connector in component.connectors:
            connector.value = float(starts[connector.name] or 0.0)
    found: dict[str, list[float]] = {name: [] for name in WATCHED}
    for k in range(STEPS):
        for component in components:
            do_step(component, k * STEP, STEP)
        for source, target in connections:
            target.value = source.value
        for component in components:
            for connector in component.connectors:
                if connector.kind == "output":
                    found.get(f"{component.name}.{connector.name}", []).append(connector.value)
    for component in components:
        component.fmu.terminate()
        component.fmu.freeInstance()
    return found


@pytest.mark.slow
@pytest.mark.parametrize(("bearing", "native"), [("simplified_caged", False), ("bushing", True)])
def test_a_tool_that_sets_nothing_runs_the_same_drop(bearing: str, native: bool, tmp_path: Path) -> None:
    if native and COMPILER is None:
        pytest.skip("no C compiler")
    scene = dropped(bearing)
    package = write_ssp(scene, tmp_path / "disk.ssp", True, native).path
    found = stepped_by_fmpy(package, tmp_path / "unpacked")
    _, values, _ = history(scene, WATCHED, in_process=True)
    assert np.max(values["bearing.journal.fy"]) > 100.0
    assert values["rotor.A.omega"][0] == pytest.approx(1256.637, rel=1e-3)
    for name in WATCHED:
        size = np.max(np.abs(values[name]))
        assert np.max(np.abs(np.array(found[name]) - values[name])) <= 1e-9 * size, name


@pytest.mark.native
def test_native_fmus_of_a_package_are_for_several_systems(tmp_path: Path) -> None:
    """Which start from the scene's values on each; zig's compiler makes those for other systems."""
    if compiler._zig() is None:
        pytest.skip("zig's compiler is not installed (pip install ziglang)")
    package = write_ssp(
        dropped("bushing"), tmp_path / "disk.ssp", True, True, ["linux-x86_64", "windows-x86_64"]
    ).path
    with zipfile.ZipFile(package) as archive:
        fmus = [io.BytesIO(archive.read(name)) for name in archive.namelist() if name.endswith(".fmu")]
    assert len(fmus) == 4
    for fmu in fmus:
        with zipfile.ZipFile(fmu) as one:
            found = {name.split("/")[1] for name in one.namelist() if name.startswith("binaries/")}
        assert found == {"linux64", "win64"}


@pytest.mark.parametrize(
    ("native", "target", "said"),
    [(False, "windows-x86_64", "add --native"), (True, "plan9-x86_64", "there are linux-x86_64, ")],
)
def test_a_wrong_target_is_refused(native: bool, target: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match=said):
        write_ssp(dropped("bushing"), tmp_path / "disk.ssp", True, native, [target])
    assert list(tmp_path.iterdir()) == []


def test_machines_that_share_a_cache_have_native_fmus_of_their_own() -> None:
    if COMPILER is None:
        pytest.skip("no C compiler")
    own = compiler.host_target()
    if own is None or not own.checked:
        pytest.skip("this machine has one target")
    kept = [_kept_as(recipe("housing"), (), names)[1] for names in ([own.name], [f"{own.name}-v2"])]
    assert len(set(kept)) == 2


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the changed disk."""
    return write_ssp(dropped(), tmp_path_factory.mktemp("travels") / "my-disk.ssp", True).path


@pytest.fixture(scope="module")
def root(package: Path) -> Element:
    """Its structure."""
    with zipfile.ZipFile(package) as archive:
        return fromstring(archive.read(SSD_FILE))


def attribute(root: Element, path: str, name: str) -> str:
    """An attribute of the element at `path`."""
    element = root.find(path, NAMESPACES)
    assert element is not None
    return element.get(name, "")


def test_annotations_lie_where_each_tool_reads_them(root: Element) -> None:
    """OMSimulator takes the system's first annotation, and none at the root or in components."""
    assert root.find("ssd:Annotations", NAMESPACES) is None
    assert root.find(".//ssd:Component/ssd:Annotations", NAMESPACES) is None
    first = "ssd:System/ssd:Annotations/ssc:Annotation[1]"
    assert attribute(root, first, "type") == "org.openmodelica"
    information = f"{first}/oms:Annotations/oms:SimulationInformation"
    assert attribute(root, information, "method") == "oms_ma"
    assert float(attribute(root, information, "fixedStepSize")) == STEP
    assert attribute(root, f"{information}/oms:FixedStepMaster", "description") == "oms-ma"
    assert float(attribute(root, f"{information}/oms:FixedStepMaster", "stepSize")) == STEP
    algorithm = "ssd:DefaultExperiment/ssd:Annotations//osp:FixedStepAlgorithm"
    assert float(attribute(root, algorithm, "baseStepSize")) == STEP


def test_names_are_identifiers(root: Element, tmp_path: Path) -> None:
    """Also those of components, wherever they are told."""
    assert root.get("name") == attribute(root, "ssd:System", "name") == "disk_caged_simplified"
    scene = parse_scene(
        {
            "zero": "mag-net.shutdown_time",
            "components": {"2nd": {"fmu": "rigid_rotor"}, "mag-net": {"fmu": "amb"}},
            "attach": [["mag-net.journal", "2nd.amb"]],
            "run": {"duration": 1e-3, "record": ["2nd.A"]},
        },
        "hyphen-ated",
        tmp_path,
    )
    again = find_scene(str(write_ssp(scene, tmp_path / "named.ssp").path))
    assert (list(again.components), again.zero) == (["x2nd", "mag_net"], "mag_net.shutdown_time")
    assert again.run.record == ("x2nd.A",)
    _, ours, _ = history(scene, ["2nd.A.y"], in_process=False)
    _, theirs, _ = history(again, ["x2nd.A.y"], in_process=False)
    assert np.array_equal(ours["2nd.A.y"], theirs["x2nd.A.y"])
    assert identifiers(["a-b", "a_b", "a b"]) == {"a-b": "a_b_2", "a_b": "a_b", "a b": "a_b_3"}


def test_texts_follow_what_was_set(package: Path, root: Element) -> None:
    """The structure's title and the FMUs' tables do; a run of the package has the scene's title."""
    title, _, changes = attribute(root, "ssd:System", "description").partition(", but with ")
    told = "rotor.speed = 12000 rpm, amb.shutdown_time = 0 s, bearing.clearance = 0.00025 m and 1 more"
    assert (title, changes) == (dropped().title, told)
    again = find_scene(str(package))
    assert again.title == title
    own = {name: spec.own for name, spec in dropped().components.items()}
    assert {name: spec.own for name, spec in again.components.items()} == own
    with zipfile.ZipFile(package) as archive:
        fmu = io.BytesIO(archive.read("resources/simplified_caged.fmu"))
    page = zipfile.ZipFile(fmu).read("documentation/index.html").decode()
    assert "<td>clearance</td><td>0.00025</td>" in page


def test_an_fmu_that_starts_as_its_model_does_is_that_of_the_model() -> None:
    own = recipe("bushing")
    assert own.starting_from({}) is own
    assert own.starting_from({"journal.x": 0.0}) is own
    other = own.starting_from({"clearance": 0.25e-3})
    assert (other.name, other.identifier) == (own.name, own.identifier)
    assert other.content != own.content
    with pytest.raises(KeyError, match=r"journal\.fx"):
        own.starting_from({"journal.fx": 1.0})


def test_fmus_given_as_files_are_said_to_stay_as_they_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    swap = ["--swap", f"bearing={cached_fmu(recipe('bushing'))}", "--set", "run.duration=1e-3"]
    assert main(["ssp", "disk-caged-simplified", *swap, "-o", str(tmp_path / "disk.ssp")]) == 0
    assert "FMUs given as files start from their own: bearing" in capsys.readouterr().out


def test_settings_and_swaps_go_onto_a_package(tmp_path: Path) -> None:
    package = tmp_path / "disk.ssp"
    write_ssp(dropped(), package)
    scene = find_scene(str(package)).set({"rotor.mass": "3 kg"}).swap(bearing="simplified_cageless")
    with opened(scene, in_process=True) as system:
        assert system.value("rotor.mass") == 3.0
        assert system.value("bearing.clearance") == 0.25e-3  # the package's, which the new one takes over
        model = system.components["bearing"].model
        assert model is not None
        assert model.name == "simplified_cageless"
