"""All files are written through one module, which follows no link: `modelkit/kernel/writing.py`."""

from __future__ import annotations

import ast
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from places import PACKAGES, ROOT

from touchdown.modelkit.kernel import writing

WRITING = ROOT / "modelkit" / "kernel" / "writing.py"
BY_METHOD = {  # of a path, whatever its arguments
    *("write_text", "write_bytes", "touch", "unlink", "rmdir", "mkdir", "chmod", "lchmod"),
    *(
        "symlink_to",
        "hardlink_to",
        "savefig",
        "savez",
        "savez_compressed",
        "savetxt",
        "to_csv",
        "to_netcdf",
    ),
    *("extractall", "extract"),
}
BY_MODULE = {
    "os": {
        *("open", "mkdir", "makedirs", "remove", "removedirs", "unlink", "rmdir", "rename", "renames"),
        *("replace", "link", "symlink", "chmod", "chown", "truncate", "mkfifo", "mknod"),
    },
    "shutil": {"copy", "copy2", "copyfile", "copytree", "move", "rmtree", "unpack_archive", "make_archive"},
    "np": {"save"},
    "py_compile": {"compile"},
    "io": {"open"},
}
ALLOWED = {  # function of a module, the call: why it may
    ("reports/figures/style.py", "save", "savefig"): "into an open file",
    ("reports/charts.py", "inline", "savefig"): "into a text",
    ("master/results/export.py", "", "to_csv"): "into an open file",
    ("studies/loop/pictures.py", "write_loops", "to_csv"): "into a text",
    ("studies/loop/pictures.py", "write_loops", "savez"): "into an open file",
    ("studies/sweep/results.py", "write_results", "to_netcdf"): "in a private folder",
    ("fmus/build.py", "write_zip", "ZipFile"): "into an open file",
    ("master/components/description.py", "_read", "ZipFile"): "into memory",
    ("master/coupling/recording_file.py", "_create", "File"): "of an open file",
    ("master/coupling/snapshot.py", "write_state", "savez"): "into an open file",
    ("command/console.py", "flush_error", "open"): "the null device",
    ("command/fault.py", "_logged", "open"): "the descriptor of mkstemp",
    ("master/coupling/assembly.py", "assemble_system", "rename"): "names of a component",
    ("fmus/python/resident.py", "_compile", "compile"): "bytecode, in a private folder",
}
NO_PATHS = {"", "model", "component", "second"}
TO_WRITE = set("wax+")


def called(node: ast.Call) -> tuple[str, str]:
    """What a call is on, where that is a name, and the function's name."""
    function = node.func
    if isinstance(function, ast.Attribute):
        return (function.value.id if isinstance(function.value, ast.Name) else "?"), function.attr
    return "", function.id if isinstance(function, ast.Name) else ""


def mode(node: ast.Call, place: int) -> str:
    """The mode that a call opens with: its argument at `place`, or by name; "w" where it is not a text."""
    given = [*node.args[place : place + 1], *(k.value for k in node.keywords if k.arg == "mode")]
    if not given:
        return "r"
    return str(given[0].value) if isinstance(given[0], ast.Constant) else "w"


def writes(node: ast.Call) -> bool:
    """Whether a call may create, change or remove a file or a folder."""
    on, name = called(node)
    if (on and name in BY_METHOD) or name in BY_MODULE.get(on, ()):
        return True
    if name in ("ZipFile", "File"):
        return bool(TO_WRITE & set(mode(node, 1)))
    if name == "open":  # of an archive it takes an entry, to read
        return on != "archive" and bool(TO_WRITE & set(mode(node, 1 if on == "" else 0)))
    # of a text `replace` takes two arguments; models and components have a `rename` of their own
    return name in ("replace", "rename") and len(node.args) == 1 and on not in NO_PATHS


def functions(tree: ast.Module) -> Iterator[tuple[str, ast.Call]]:
    """All calls of a module, each with the name of the function that it is in."""

    def within(node: ast.AST, name: str) -> Iterator[tuple[str, ast.Call]]:
        for inner in ast.iter_child_nodes(node):
            if isinstance(inner, ast.Call):
                yield name, inner
            is_function = isinstance(inner, ast.FunctionDef | ast.AsyncFunctionDef)
            yield from within(inner, inner.name if is_function else name)

    return within(tree, "")


def test_nothing_is_written_around_the_module() -> None:
    found: dict[tuple[str, str, str], int] = {}
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            if path == WRITING:
                continue
            for function, node in functions(ast.parse(path.read_text(encoding="utf-8"))):
                if writes(node):
                    place = (str(path.relative_to(ROOT)), function, called(node)[1])
                    found[place] = node.lineno
    around = {
        f"{file}:{line} {name}" for (file, f, name), line in found.items() if (file, f, name) not in ALLOWED
    }
    assert not around
    assert found.keys() == ALLOWED.keys()  # none is allowed that is not there


def test_a_link_is_replaced_and_what_it_leads_to_is_kept(tmp_path: Path) -> None:
    (tmp_path / "theirs").write_text("kept")
    path = tmp_path / "page.html"
    path.symlink_to("theirs")
    writing.write(path, "new")
    assert (path.read_text(), path.is_symlink()) == ("new", False)
    assert (tmp_path / "theirs").read_text() == "kept"


def test_what_fails_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")
    with suppress(InterruptedError), writing.replacing_text(path) as file:
        file.write("half of it")
        raise InterruptedError
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
    # by name it is made elsewhere: beside it, others might have put a link in the way of what follows one
    with writing.replacing_by_name(tmp_path / "film.GIF") as made:
        assert not made.is_relative_to(tmp_path)
        assert made.suffix == ".gif"
        made.write_text("frames")
    assert (tmp_path / "film.GIF").read_text() == "frames"


@pytest.mark.parametrize("name", ["", ".", "..", "../x", "a/b", "/etc/passwd", "a\0b"])
def test_a_name_that_was_read_stays_in_its_folder(name: str, tmp_path: Path) -> None:
    with pytest.raises(OSError, match="cannot be the name of a file in it"):
        writing.child_path(tmp_path, name)
    assert writing.child_path(tmp_path, "a b.png") == tmp_path / "a b.png"


def test_removing_follows_no_link(tmp_path: Path) -> None:
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    (theirs / "letter").write_text("kept")
    for name in ("link", "holding"):
        (tmp_path / name).symlink_to(theirs)
        writing.remove(tmp_path / name)
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "link").symlink_to(theirs)
    writing.remove(tmp_path / "folder")
    assert [path.name for path in tmp_path.iterdir()] == ["theirs"]
    assert (theirs / "letter").read_text() == "kept"


PLANTED: dict[str, Callable[[Path], object]] = {
    "a file more": lambda folder: (folder / "in" / "more").write_text(""),
    "a folder more, with a file": lambda folder: make(folder / "more" / "file"),
    "a file less": lambda folder: (folder / "in" / "file").unlink(),
    "a link in place of a file": lambda folder: linked(folder / "in" / "file"),
    "a link in place of a folder": lambda folder: linked(folder / "in"),
    "a pipe": lambda folder: os.mkfifo(folder / "pipe"),
    "a file that others can write": lambda folder: (folder / "in" / "file").chmod(0o602),
    "a folder that others can write": lambda folder: (folder / "in").chmod(0o720),
}


def make(path: Path) -> Path:
    """A file, and the folders above it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")
    return path


def linked(path: Path) -> None:
    """Move what is there elsewhere, and put a link to it in its place."""
    elsewhere = path.rename(path.parents[2] / "elsewhere")
    path.symlink_to(elsewhere)


@pytest.mark.parametrize("plant", PLANTED.values(), ids=PLANTED)
def test_a_folder_of_a_cache_holds_exactly_what_it_should(
    plant: Callable[[Path], object], tmp_path: Path
) -> None:
    folder = tmp_path / "a" / "b"
    files = {"top", "in/file"}
    for name in files:
        make(folder / name).chmod(0o600)
    for place in (folder, folder / "in"):
        place.chmod(0o700)
    assert writing.holds_exactly(folder, files)
    plant(folder)
    assert not writing.holds_exactly(folder, files)


def test_another_users_files_are_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = writing.write(tmp_path / "code", b"code", writing.PRIVATE)
    assert writing.read_own(path) == b"code"
    (tmp_path / "link").symlink_to(path)
    with pytest.raises(OSError, match="symbolic links"):
        writing.read_own(tmp_path / "link")
    monkeypatch.setattr(os, "geteuid", lambda: 12345)
    with pytest.raises(PermissionError):
        writing.read_own(path)


@pytest.mark.parametrize(
    ("before", "asked", "after"),
    [(0o600, 0o666, 0o600), (0o666, 0o666, 0o666), (0o755, 0o666, 0o644), (0o644, writing.PRIVATE, 0o600)],
)
def test_a_file_that_is_replaced_keeps_its_mode(
    tmp_path: Path, before: int, asked: int, after: int
) -> None:
    """Not that it could be run; a private file is private whatever was there; folders stay as they are."""
    path = make(tmp_path / "file")
    path.chmod(before)
    writing.write(path, "new", asked)
    assert stat.S_IMODE(path.stat().st_mode) == after
    assert path.read_text() == "new"
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    theirs.chmod(0o751)
    writing.make_folder(theirs / "a" / "b", 0o700)
    modes = [stat.S_IMODE(p.stat().st_mode) for p in (theirs, theirs / "a", theirs / "a" / "b")]
    assert modes == [0o751, 0o700, 0o700]
    with pytest.raises(FileExistsError):
        writing.make_folder(path)


def test_a_file_in_place_of_a_link_or_of_another_users_file_has_a_mode_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    usual = stat.S_IMODE(writing.write(tmp_path / "usual", "").stat().st_mode)
    behind = make(tmp_path / "behind")
    behind.chmod(0o600)
    (tmp_path / "link").symlink_to(behind)
    assert stat.S_IMODE(writing.write(tmp_path / "link", "").lstat().st_mode) == usual != 0o600
    monkeypatch.setattr(os, "geteuid", lambda: 12345)
    assert stat.S_IMODE(writing.write(behind, "").stat().st_mode) == usual
