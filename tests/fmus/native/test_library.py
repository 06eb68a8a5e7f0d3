"""What a native FMU's file is: a library that needs a C library and shows FMI's functions, and no more."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest

from touchdown.command.cli import main
from touchdown.fmus.native import c_tables, compiler, kernels
from touchdown.fmus.native.compiler import TARGETS, NativeError, host_target, library_folders
from touchdown.fmus.native.native_build import Native as Choice
from touchdown.fmus.native.native_build import build_native
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.common.errors import FAILED
from touchdown.modelkit.model import slots

pytestmark = pytest.mark.slow

Native = Callable[[str], Path]
CHEAP = ("housing", "rigid_rotor", "rotor_I")
every_model = pytest.mark.parametrize(
    "fmu",
    [*CHEAP, *(pytest.param(name, marks=pytest.mark.native) for name in fmu_names() if name not in CHEAP)],
)
GLIBC = {"libc.so.6", "libm.so.6"}


def library(folder: Path) -> Path:
    """The library for Linux in an unpacked FMU."""
    (found,) = (folder / "binaries" / "linux64").iterdir()
    return found


def said(*command: str | Path) -> str:
    """What a tool prints; skips where it is not installed."""
    if shutil.which(str(command[0])) is None:
        pytest.skip(f"{command[0]} is not installed")
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@every_model
def test_it_needs_a_c_library_and_shows_the_functions_of_fmi(fmu: str, native: Native):
    path = library(native(fmu))
    needed = set(re.findall(r"NEEDED.*\[(.*)\]", said("readelf", "-d", path)))
    assert needed <= GLIBC
    shown = [line.split() for line in said("nm", "-D", path).splitlines()]
    defined = {words[2] for words in shown if len(words) == 3 and words[1] == "T"}
    assert {name[:4] for name in defined} == {"fmi2"}
    assert {"fmi2DoStep", "fmi2DeSerializeFMUstate", "fmi2GetDirectionalDerivative"} < defined
    assert [words[-1] for words in shown if words[-1].startswith(("Py", "_Py", "NRT_", "numba"))] == []


@every_model
def test_its_description_is_that_of_the_fmu_in_python(
    fmu: str, native: Native, unpacked: Mapping[str, Path]
):
    """Variables, value references, units, structure: all but who made it, its GUID and what it needs."""
    own, other = (
        fromstring((folder / "modelDescription.xml").read_bytes())
        for folder in (native(fmu), unpacked[fmu])
    )
    assert own.attrib["guid"] != other.attrib["guid"]
    assert own.attrib["generationTool"].endswith(", native")
    for name in ("guid", "generationTool"):
        del own.attrib[name], other.attrib[name]
    needs = [root.find("CoSimulation").attrib.pop("needsExecutionTool") for root in (own, other)]  # type: ignore[union-attr]
    assert needs == ["false", "true"]
    assert list(map(_plain, own.iter())) == list(map(_plain, other.iter()))


def _plain(element: object) -> tuple[object, ...]:
    return element.tag, element.attrib, (element.text or "").strip()  # type: ignore[attr-defined]


def test_equal_sources_give_equal_bytes(native: Native, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Kernels compiled anew included."""
    native("housing")
    target = host_target()
    assert target is not None
    monkeypatch.setattr(kernels, "unsealed", lambda path: None)
    one, two = (
        build_native(recipe("housing"), tmp_path / name, Choice((target,))).read_bytes()
        for name in ("one", "two")
    )
    assert one == two


def test_words_are_turned_into_formats():
    assert c_tables.printf("at {time:.9g} s: {why}, {0:g}") == ("at %.9g s: %s, %g", ["time", "why", "0"])
    for impossible in ("{0:.3f}", "half a % of it", "{0!r:x}"):
        with pytest.raises(ValueError, match="C cannot print"):
            c_tables.printf(impossible)


@pytest.mark.parametrize("fmu", fmu_names())
def test_every_text_of_a_model_can_be_said_in_c(fmu: str):
    model = recipe(fmu).model
    for text in model.problems:
        c_tables.quoted(c_tables.printf(text)[0])
    for slot in slots(model):
        c_tables.quoted(slot.variable.name)


# -- what cannot be built ------------------------------------------------------------------------------


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What the command says, in one line, where it refuses."""
    assert main(["build", *arguments]) == FAILED
    words = capsys.readouterr().err
    assert len(words.splitlines()) == 1
    return words


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--native", "--target", "plan9-x86_64"], "there are linux-x86_64, "),
        (["--native", "--target", "linux-x86_64,linux-x86_64-v2"], "have one place in an FMU"),
        (["--target", "linux-x86_64"], "add --native"),
        (["--native", "rotor_I", "--modes", "2,x"], "whole numbers"),
        (["--native", "no_such.py"], "cannot read no_such.py"),
    ],
)
def test_a_wrong_option_is_named(
    arguments: list[str], named: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
):
    if host_target() is None:
        pytest.skip("native FMUs are not built for this machine")
    assert named in refused(capsys, *arguments, "-o", str(tmp_path))
    assert list(tmp_path.rglob("*.fmu")) == []


# -- other machines --------------------------------------------------------------------------------------

HEADS = {".so": b"\x7fELF", ".dll": b"MZ", ".dylib": b"\xcf\xfa\xed\xfe"}


@pytest.mark.native
def test_one_file_holds_libraries_for_all_machines(tmp_path: Path):
    """Built where zig's compiler is installed; those that run here are tried elsewhere in these tests."""
    if compiler._zig() is None:
        pytest.skip("zig's compiler is not installed (pip install 'touchdown-cosim[native]')")
    chosen = tuple(target for target in TARGETS.values() if not target.name.endswith("-v2"))
    path = build_native(recipe("housing"), tmp_path, Choice(chosen))
    with zipfile.ZipFile(path) as archive:
        for place, target in library_folders(chosen).items():
            content = archive.read(f"binaries/{place}/Housing{target.suffix}")
            assert content.startswith(HEADS[target.suffix])
            assert b"fmi2DoStep" in content


def test_arm_lies_where_hosts_look():
    arm, intel = TARGETS["linux-aarch64"], TARGETS["linux-x86_64"]
    assert library_folders((arm,)) == {"aarch64-linux": arm, "linux64": arm}
    assert library_folders((arm, intel)) == {"aarch64-linux": arm, "linux64": intel}


def test_kernels_that_need_python_are_refused_by_name():
    """In the process that compiles them; a slice assignment compares shapes, and says so in Python."""
    script = (
        "import sys, types; from touchdown.fmus.native import kernels; import numba\n"
        "place = sys.modules['place'] = types.ModuleType('place')\n"
        "@numba.njit(error_model='numpy')\n"
        "def needy(words):\n"
        "    words[:] = words[1:].copy()\n"
        "    return 0\n"
        "place.needy = needy\n"
        "kernels.compile_entries({'kernels': {'derive': 'place:needy'}, 'words': 3, 'state': 1})\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, env=os.environ
    )
    assert done.returncode == 1
    assert f"{NativeError.__name__}: they need Py" in done.stderr


def test_what_lies_in_the_current_folder_is_not_imported(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Kernels are compiled by a program of its own, which a file called as a module must not mislead."""
    (tmp_path / "json.py").write_text("raise SystemExit('json of the current folder')", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    done = kernels.run_apart("nowhere", "no order")
    assert "json of the current folder" not in done.stderr
    assert "JSONDecodeError" in done.stderr
