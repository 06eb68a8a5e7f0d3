"""The folder of a run's results: a run writes and removes nothing but its own files there."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.folder import LOCK_FILE, SCENE, SUMMARY_FILE, claimed, reopened
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene, read_resolved


def begin(folder: Path, components: dict[str, object]) -> None:
    """Begin a run in a folder whose scene, as an earlier run left it, has these components."""
    (folder / SCENE).write_text(json.dumps({"components": components}))
    with claimed(folder) as results:
        results.begin({"components": {}})


@pytest.mark.parametrize("name", ["/../../theirs/photo", "/../photo", "../photo", "{theirs}/photo"])
def test_names_in_an_earlier_scene_lead_nowhere(name: str, tmp_path: Path) -> None:
    """Pictures are removed that lie in the folder; names from its scene.json build no path."""
    folder, theirs = tmp_path / "runs" / "run", tmp_path / "theirs"
    for place in (folder, folder / "orbit-", theirs):
        place.mkdir(parents=True)
    others = [place / "photo.png" for place in (theirs, tmp_path, tmp_path / "runs", folder)]
    own = folder / "orbit-bearing.png"
    for picture in (*others, own):
        picture.write_bytes(b"")
    begin(folder, {name.format(theirs=theirs): {}, "bearing": {}})
    assert all(picture.exists() for picture in others)
    assert not own.exists()


def symbolic(name: Path, theirs: Path) -> None:
    name.symlink_to(theirs)


def hard(name: Path, theirs: Path) -> None:
    name.hardlink_to(theirs)


@pytest.mark.parametrize("link", [symbolic, hard])
def test_a_lock_that_is_a_link(link: Callable[[Path, Path], None], tmp_path: Path) -> None:
    """The file behind it keeps its content, and the message names the lock."""
    theirs = tmp_path / "theirs"
    theirs.write_text("kept")
    link(tmp_path / LOCK_FILE, theirs)
    with pytest.raises(TouchdownError, match=f"{LOCK_FILE} is a link"), claimed(tmp_path):
        pass
    assert theirs.read_text() == "kept"


def test_a_lock_that_is_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / LOCK_FILE)
    with (
        pytest.raises(TouchdownError, match=f"{LOCK_FILE} is a link or no regular file"),
        claimed(tmp_path),
    ):
        pass


def test_links_of_results_go_and_their_files_stay(tmp_path: Path) -> None:
    theirs = tmp_path / "theirs"
    theirs.write_text("kept")
    names = (SUMMARY_FILE, "result.h5", "ending.json")
    for name in names:
        (tmp_path / name).symlink_to(theirs)
    begin(tmp_path, {})
    (tmp_path / SUMMARY_FILE).symlink_to(theirs)
    with claimed(tmp_path) as results:
        results.finish({"completed": True})
    assert theirs.read_text() == "kept"
    assert not any((tmp_path / name).is_symlink() for name in names)
    assert json.loads((tmp_path / SUMMARY_FILE).read_text()) == {"completed": True}


def test_what_a_killed_run_left_unfinished_goes(tmp_path: Path) -> None:
    left, theirs = tmp_path / f".{SUMMARY_FILE}.0123456789abcdef.part", tmp_path / ".letter.part"
    for path in (left, theirs):
        path.write_text("")
    begin(tmp_path, {})
    assert not left.exists()
    assert theirs.exists()


def test_what_an_earlier_version_left_says_so(tmp_path: Path) -> None:
    """In one line: its summary was flat, and gaps were lists."""
    scene = load_scene("disk-caged-simplified").set({"run.duration": 1e-4})
    run_scene(scene, tmp_path, in_process=True).recording.close()
    summary = json.loads((tmp_path / "summary.json").read_text())
    (tmp_path / "summary.json").write_text(json.dumps(summary | {"end_time_s": summary.pop("end_time")}))
    with pytest.raises(TouchdownError, match=r"summary\.json: an earlier version left it; run"):
        reopened(tmp_path)
    left = json.loads((tmp_path / "scene.json").read_text()) | {"gaps": [["AMB A", "rotor.amb", 4e-4]]}
    (tmp_path / "scene.json").write_text(json.dumps(left))
    with pytest.raises(TouchdownError, match="an earlier version left it; run the scene again"):
        read_resolved(tmp_path / "scene.json")


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a run left."""
    folder = tmp_path_factory.mktemp("left")
    scene = load_scene("disk-caged-simplified").set({"run.duration": "1 ms"})
    run_scene(scene, folder, in_process=True).recording.close()
    return folder


WRONG = {  # file, where in it, and what stands there
    "a summary that is a list": ("summary.json", (), [1]),
    "seats that are a text": ("summary.json", ("seats",), "x"),
    "a seat that is null": ("summary.json", ("seats", "A"), None),
    "a number that is a text": ("summary.json", ("seats", "A", "peak_contact_force"), "1 N"),
    "a number that is none": ("summary.json", ("macro_steps",), float("nan")),
    "an end that is unknown": ("summary.json", ("ended",), "well"),
    "components that are a number": ("ending.json", ("components",), 3),
    "a variable of half a row": ("ending.json", ("components", "rotor", 0), ["mass", 1]),
    "a variable of another kind": ("ending.json", ("components", "rotor", 0, 2), "Number"),
    "an attachment to nothing": ("ending.json", ("attachments", 0, 0), "nothing"),
    "a scale of text": ("ending.json", ("connections", 0, 4), ["a", "b"]),
    "a component that is null": ("scene.json", ("components", "rotor"), None),
}


@pytest.mark.parametrize(("file", "place", "value"), WRONG.values(), ids=WRONG)
def test_a_value_that_is_not_of_its_kind(
    file: str, place: tuple[str | int, ...], value: object, left: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(left, tmp_path / "run"))
    content = json.loads((folder / file).read_text())
    inner = content
    for key in place[:-1]:
        inner = inner[key]
    if place:
        assert inner[place[-1]] != value
        inner[place[-1]] = value
    (folder / file).write_text(json.dumps(content if place else value))
    with pytest.raises(TouchdownError, match=str(folder)):
        reopened(folder)


def test_a_quantity_that_a_summary_lacks_did_not_happen(left: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(left, tmp_path / "run"))
    summary = json.loads((folder / SUMMARY_FILE).read_text())
    del summary["not_audited"], summary["seats"]["A"]["whirl"]
    (folder / SUMMARY_FILE).write_text(json.dumps(summary))
    found = reopened(folder).summary
    assert found["not_audited"] is None
    assert found["seats"]["A"]["whirl"] is None
