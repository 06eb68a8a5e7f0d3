"""The command's own help, version and completion."""

from __future__ import annotations

import argparse
import os
import platform
import shlex
import subprocess
from pathlib import Path

import pytest
from places import COMMAND

from touchdown.command.cli import joined, main, parser
from touchdown.command.verbs import ALL
from touchdown.command.verbs.arguments import chosen_scene, swapped
from touchdown.fmus.scripts import scripts
from touchdown.fmus.version import VERSION
from touchdown.master.interop.scenes import find_scene
from touchdown.master.scene.file import shipped
from touchdown.master.scene.schemes import SCHEMES

EXAMPLES = [pytest.param(verb, line, id=line) for verb in ALL for line in verb.examples]
SLOW = {"numba", "scipy", "matplotlib", "h5py", "fmpy"}


def parsed(line: str) -> argparse.Namespace:
    """The options of a whole command line, as the command itself reads it."""
    name, *arguments = shlex.split(line)
    assert name == "touchdown"
    return parser().parse_args(joined(arguments))


@pytest.mark.parametrize(("verb", "line"), EXAMPLES)
def test_an_example_is_of_its_verb_and_what_it_asks_for_exists(verb, line: str) -> None:
    options = parsed(line)
    assert options.run is verb.execute
    if hasattr(options, "scheme"):
        chosen_scene(options)
    elif hasattr(options, "swap") and getattr(options, "scene", None):
        swapped(find_scene(options.scene), options)
    elif getattr(options, "scene", None):
        # none that is shipped requires anything
        assert options.scene in shipped() or options.scene == "my-machine/required.toml"


@pytest.mark.parametrize("verb", ALL, ids=lambda verb: verb.name)
def test_help_shows_the_examples_as_they_are_typed(verb, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([verb.name, "--help"])
    text = capsys.readouterr().out
    assert verb.examples
    for line in verb.examples:
        assert f"\n  {line}\n" in text


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["runn", "x"], "there is no verb runn; did you mean run; see touchdown --help"),
        (["run", "a", "b"], "touchdown run takes no argument b here; see touchdown run --help"),
        (
            ["run", "a", "--scheem=3"],
            "has no option --scheem=3; did you mean --scheme; see touchdown run --help",
        ),
        (["run", "a", "--zzz"], "touchdown run has no option --zzz; see touchdown run --help"),
    ],
)
def test_a_verb_or_an_option_that_does_not_exist_is_one_line(
    arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert says in told.err
    assert told.err.count("\n") == 1


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    text = capsys.readouterr().out
    assert text.startswith(f"touchdown-cosim {VERSION}, Python {platform.python_version()}, numba ")
    assert text.count("\n") == 1


def tab(line: str, folder: Path) -> tuple[list[str], set[str]]:
    """What the shell is offered at the end of `line`, and the packages imported to find it."""
    answer = folder / "answer"
    asked = {
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_IFS": "\n",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
        "PYTHONPROFILEIMPORTTIME": "1",
    }
    ended = subprocess.run(
        COMMAND, env=os.environ | asked, capture_output=True, text=True, timeout=60, check=True
    )
    imported = {row.rpartition("|")[2].strip().partition(".")[0] for row in ended.stderr.splitlines()}
    assert "argcomplete" in imported
    return [word.strip() for word in answer.read_text(encoding="utf-8").splitlines()], imported


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("touchdown ru", ["run"]),
        ("touchdown run dis", [name for name in shipped() if name.startswith("dis")]),
        ("touchdown run disk-caged-simplified --scheme jacobi", [n for n in SCHEMES if n[:6] == "jacobi"]),
        ("touchdown run disk-caged-simplified --set run.macro", ["run.macro_step="]),
        ("touchdown sweep rotor1-9000 --set rotor.mod", ["rotor.modes="]),
        (
            "touchdown run disk-caged-simplified --swap bearing=det",
            [f"bearing={n}" for n in scripts() if n[:3] == "det"],
        ),
        ("touchdown scenes disk-caged-simplified --variables h", ["housing"]),
    ],
)
def test_completion_offers_what_there_is_and_imports_nothing_slow(
    line: str, wanted: list[str], tmp_path: Path
) -> None:
    offered, imported = tab(line, tmp_path)
    assert wanted
    assert sorted(offered) == sorted(wanted)
    assert not imported & SLOW
