"""Names of variables are data: what a third-party FMU calls them, the recording and the table call them."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from archives import archive, entries_of, saying
from pythonfmu import FmuBuilder

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.recording_file import END, TIME, Contents, RecordedColumn, RecordedTable
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.xml import NAMESPACES, SSD_FILE
from touchdown.master.results.export import export
from touchdown.master.results.recording import Recording
from touchdown.master.results.result import Result
from touchdown.master.results.run import run_scene
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import Scene

NAMES = (
    *(
        "der(x,1)",
        "'a\"b'",
        "<&>",
        "Subsystem/Gain",
        "Subsystem",
        "Größe",
        "A[1,2]",
        "contact_time",
        "ring.sync_time",
        "time",
        "/abs",
        "a//b",
    ),
    *(
        ".",
        "..",
        "...",
        "x y ",
        "x/",
        "%s",
        "a%2Fb",
        "a.b.c",
        "line\nend",
        "tab\tin",
        "bell\x7f",
        "long " * 2000,
    ),
)
LONG = tuple(f"cell[{i},{j}].T" for i in (1, 2) for j in (1, 2, 3))
SOURCE = """
import json
import re
from pathlib import Path

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Named(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for number, name in enumerate(json.loads(TEXT), 1):
            self.register_variable(
                Real(name, causality=Fmi2Causality.output, getter=lambda value=float(number): value)
            )
        self.p = 7.0
        self.register_variable(Real("p", start=7.0, causality=Fmi2Causality.parameter, variability=None))

    def do_step(self, current_time, step_size):
        return True
"""


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An FMU whose outputs are NAMES and LONG, and give 1, 2 ..."""
    folder = tmp_path_factory.mktemp("named")
    script = folder / "named.py"
    marked = [name.replace("\n", "@10@").replace("\t", "@9@") for name in (*NAMES, *LONG)]
    script.write_text(SOURCE.replace("TEXT", repr(json.dumps(marked))))
    made = FmuBuilder.build_FMU(script, dest=folder)  # which writes line ends that XML makes spaces of
    described = entries_of(made)["modelDescription.xml"].decode()
    return saying(made, folder / "data.fmu", described, re.sub(r"@(\d+)@", r"&#\1;", described))


def packaged(fmu: Path, folder: Path, *components: str) -> Scene:
    """The scene of a package in which the FMU goes by these names."""
    spaces = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())
    elements = "".join(f'<ssd:Component name="{name}" source="named.fmu"/>' for name in components)
    text = f"""<ssd:SystemStructureDescription {spaces} version="1.0" name="n"><ssd:System name="s">
<ssd:Elements>{elements}</ssd:Elements></ssd:System><ssd:DefaultExperiment stopTime="0.002"/>
</ssd:SystemStructureDescription>"""
    scene = find_scene(str(archive(folder / "n.ssp", {SSD_FILE: text, "named.fmu": fmu.read_bytes()})))
    return scene.set({"run.macro_step": 1e-3, "run.record_every": 1})


@pytest.fixture(scope="module")
def result(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Result:
    folder = tmp_path_factory.mktemp("run")
    scene = packaged(fmu, folder, "plant").set({"run.record_arrays": True})
    return run_scene(scene, folder / "out")


def test_every_variable_is_recorded_under_its_name(result: Result) -> None:
    for number, name in enumerate(NAMES, 1):
        assert float(result.data[f"plant.{name}"][-1]) == number
        assert result.recording.at_end(f"plant.{name}") == number
    assert [name for name, _ in result.recording.columns()] != []
    assert result.data.attrs.keys() == {
        "title",
        "scene",
        "version",
        "scheme",
        "macro_step_s",
        "zero_s",
        "third_party",
    }


def test_instants_are_the_projects_own_and_those_of_the_contract(fmu: Path, tmp_path: Path) -> None:
    scene = replace(packaged(fmu, tmp_path, "plant"), zero="1 ms")
    data = run_scene(scene, tmp_path / "out").data
    for name, after in (("contact_time", 0.0), ("ring.sync_time", 1e-3)):
        assert float(data[f"plant.{name}"][-1]) == 1 + NAMES.index(name) - after


def test_the_table_has_a_name_over_each_column(result: Result) -> None:
    with export(result, result.folder / "result.csv", "csv").open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    last = dict(zip(names, map(float, rows[-1]), strict=True))
    assert {f"plant.{name} [1]": float(k) for k, name in enumerate(NAMES, 1)}.items() <= last.items()


def test_the_file_says_that_names_are_encoded_where_they_are(result: Result, tmp_path: Path) -> None:
    with h5py.File(result.folder / "result.h5") as file:
        assert file.attrs["names"] == "percent-encoded"
        assert file["plant/Subsystem%2FGain"][-1] == 1 + NAMES.index("Subsystem/Gain")
    table = RecordedTable(tmp_path / "plain.h5", Contents({}, [RecordedColumn("a/x.y", "m", "")]), 1)
    table.append(np.zeros((1, 2)))
    table.close()
    with h5py.File(tmp_path / "plain.h5") as file:
        assert "names" not in file.attrs


def test_files_of_earlier_versions_are_read(tmp_path: Path) -> None:
    """They have a % as it is, and made groups of a /."""
    columns = [RecordedColumn(f"plant/{name}", "m", "") for name in ("a%2Fb", "load/x")]
    table = RecordedTable(tmp_path / "old.h5", Contents({}, columns), 1)
    table.append(np.array([[0.0, 1.0, 2.0]]))
    table.close()
    recording = Recording(tmp_path / "old.h5")
    assert recording.columns() == [("plant.a%2Fb", "m")]
    assert (recording["plant.a%2Fb"][0], recording["plant.load/x"][0]) == (1.0, 2.0)
    recording.close()


def test_components_of_a_package_get_names_that_scenes_can_have(fmu: Path, tmp_path: Path) -> None:
    scene = packaged(
        fmu, tmp_path, "a,b", "a;b", "&quot;x/y&quot;", "-", TIME, END, "run", "a\x85b", "größe"
    )
    assert list(scene.components) == [
        *("a_b", "a_b_2", "_x_y_", "_", "time_2", "at_end_2", "run_2", "a_b_3", "größe"),
    ]


@pytest.mark.parametrize("key", ["record", "record_also"])
def test_a_whole_name_is_recorded_whatever_is_left_out_by_default(
    key: str, fmu: Path, tmp_path: Path
) -> None:
    """Also from text with commas between the names, which may have commas in brackets."""
    asked = "plant.cell[1,2].T, plant.der(x,1), plant.p"
    run = run_scene(packaged(fmu, tmp_path, "plant").set({f"run.{key}": asked}), tmp_path / "out")
    columns = {name for name, _ in run.recording.columns()}
    assert columns >= {"plant.cell[1,2].T", "plant.der(x,1)", "plant.p"}
    assert "plant.cell[1,1].T" not in columns
    assert (len(columns) == 3) == (key == "record")


def test_a_filter_that_matches_nothing_is_refused(fmu: Path, tmp_path: Path) -> None:
    """An element of a long array has only been begun: its default is to be left out."""
    scene = packaged(fmu, tmp_path, "plant").set({"run.record": ["plant.p", "plant.cell[1,1]"]})
    with pytest.raises(TouchdownError, match=r"run\.record: nothing of plant\.cell\[1,1\] is recorded"):
        run_scene(scene, tmp_path / "out")
    columns = run_scene(scene.set({"run.record_arrays": True}), tmp_path / "out").recording.columns()
    assert [name for name, _ in columns] == ["plant.cell[1,1].T", "plant.p"]


def test_commas_in_brackets_part_no_names() -> None:
    spec = with_changes(RunSpec(), {"record": "a.A[1,2], b.f(A[1, 2],3),c"})
    assert spec.record == ("a.A[1,2]", "b.f(A[1, 2],3)", "c")
    with pytest.raises(TouchdownError, match=r"run\.record"):
        with_changes(RunSpec(), {"record": "a,,b"})
