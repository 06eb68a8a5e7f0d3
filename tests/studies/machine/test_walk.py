"""The page that leads from a drawing to a drop: its files are what it says, its commands are commands."""

from __future__ import annotations

import re
import shlex
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest
from places import ROOT

from touchdown.bearings.catalogue.bearing_file import read_bearings
from touchdown.command.cli import main, parser
from touchdown.master.interop.find_scene import find_scene
from touchdown.rotor.file import load_rotor

_spec = spec_from_file_location("walk", ROOT / ".ci" / "walk.py")
assert _spec is not None
walk = module_from_spec(_spec)
assert _spec.loader is not None
_spec.loader.exec_module(walk)


def test_its_rotor_becomes_its_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All but the runs themselves, which continuous integration does."""
    monkeypatch.chdir(tmp_path)
    done = []
    for name, text in walk.steps(ROOT / "docs" / "own-machine.md"):
        if name:
            (tmp_path / name).write_text(text, encoding="utf-8")
            continue
        words = shlex.split(text)
        options = parser().parse_args(words[1:])
        done.append(words[1])
        if words[1] == "new":
            assert main(words[1:]) == 0
        elif words[1] == "run" and not (options.continue_from or options.worst):
            changes = dict(s.split("=") for s in options.settings or ())
            assert find_scene(options.scene_name).set(changes).attach
    assert done[:6] == ["rotor", "catalogue", "new", "run", "report", "run"]
    assert {"whirl", "rank", "animate", "sweep", "survival", "diff"} <= set(done)
    assert load_rotor("rotor.toml").mass == pytest.approx(60.0, abs=0.5)


def test_each_question_is_answered_by_a_command_that_is_run() -> None:
    """Of the table on the page; continuous integration runs the commands above it."""
    page = ROOT / "docs" / "own-machine.md"
    _, _, table = page.read_text(encoding="utf-8").partition("## Sixteen questions\n")
    rows = re.findall(r"^\| (.+\?) \| `(.+?)`", table.partition("\n## ")[0], re.MULTILINE)
    ran = [text for name, text in walk.steps(page) if not name]
    assert sum(question.count("?") + question.count(", ") for question, _ in rows) >= 16
    for question, command in rows:
        assert any(line.startswith(command) for line in ran), question


def test_the_page_of_bearings_has_one_that_can_be_read(tmp_path: Path) -> None:
    for name, text in walk.steps(ROOT / "docs" / "bearings.md"):
        if name:
            (tmp_path / name).write_text(text, encoding="utf-8")
            made = read_bearings(tmp_path / name)["B7014 of the drawing"]
            assert made.balls.count == 19
            return
    pytest.fail("the page names no file")


MAKES_A_VERB = "architecture.md"  # shows how one is added
PAGES = sorted({page.name for page in (ROOT / "docs").glob("*.md")} - {MAKES_A_VERB})


@pytest.mark.parametrize("page", PAGES)
def test_commands_of_the_pages_are_commands(page: str) -> None:
    """They parse, and a scene that is named is there or made by a command above."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    for block in re.findall(r"^```sh\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line.partition(" > ")[0], comments=True)
            if words[:1] != ["touchdown"] or "..." in words:
                continue
            options = parser().parse_args(words[1:])
            scene = getattr(options, "scene", None)
            if words[1] == "run" and isinstance(scene, str) and not re.search(r"[/.]|^my-", scene):
                find_scene(scene)
