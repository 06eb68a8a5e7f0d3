"""The command's own help, version and completion."""

from __future__ import annotations

import argparse
import os
import platform
import shlex
import subprocess
from pathlib import Path
from typing import Literal

import pytest
from places import COMMAND

from touchdown.command.cli import main, parser
from touchdown.command.options import Verb, called
from touchdown.command.parameters import Length, Places, Times
from touchdown.command.verbs import ALL
from touchdown.fmus.scripts import scripts
from touchdown.fmus.version import VERSION
from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.file import shipped

EXAMPLES = [pytest.param(verb, line, id=line) for verb in ALL for line in verb.examples]
SLOW = {"numba", "scipy", "matplotlib", "h5py", "fmpy"}


def parsed(line: str) -> argparse.Namespace:
    """The options of a whole command line, as the command itself reads it."""
    name, *arguments = shlex.split(line)
    assert name == "touchdown"
    return parser().parse_args(arguments)


@pytest.mark.parametrize(("verb", "line"), EXAMPLES)
def test_an_example_is_of_its_verb_and_what_it_asks_for_exists(verb, line: str) -> None:
    options = parsed(line)
    assert options.execute == verb.execute
    values = {name: option.value(options) for name, option in verb.options().items()}
    scene = values.get("scene_name")
    if scene and scene != "my-machine/required.toml":  # none that is shipped requires anything
        for build in verb.builders.values():
            called(build, values)


def test_the_verbs_are_few_and_every_option_has_its_help() -> None:
    options = [option for verb in ALL for option in verb.options().values()]
    assert len(ALL) <= 20
    assert len({option.name for option in options}) <= 100
    assert all(option.meaning for option in options)


def test_parameters_become_options() -> None:
    """Positional and named ones, flags both ways, quantities with units, lists, choices and defaults."""

    def probe(
        scene: object,
        gap: Length = "1 mm",
        *,
        times: Times = (),
        kind: Literal[2, 3] = 2,
        at: Places | None = None,
        drawn: bool = True,
        unseen: int = 7,
        progress: bool = False,
    ) -> list[object]:
        """Probe.

        gap: of it, on two
            lines
        times: of it
        kind: of it
        at: of it
        drawn: draw it
        """
        return [scene, gap, times, kind, at, drawn, unseen, progress]

    def named(scene_name: str) -> list[str]:
        return [scene_name]

    verb = Verb("probe", probe, lambda found: found, builders={"scene": named})
    command = argparse.ArgumentParser()
    verb.add_to(command.add_subparsers())
    words = [
        "probe",
        "x",
        "2mm",
        "--times",
        "5,1s",
        "--kind",
        "3",
        "--at",
        "A=1,B=2",
        "--no-drawn",
        "--quiet",
    ]
    options = command.parse_args(words)
    assert options.execute(options) == [["x"], "2mm", [1.0, 5.0], 3, {"A": "1", "B": "2"}, False, 7, False]
    for text, said in (("0 mm", "GAP 0 mm must be above 0"), ("1 kg", "it is measured in m")):
        options = command.parse_args(["probe", "x", text])
        with pytest.raises(TouchdownError, match=said):
            options.execute(options)
    assert verb.options()["gap"].meaning == "of it, on two lines"
    assert "--unseen" not in options.help_text()


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
        (["runn", "x"], "there is no verb runn; did you mean run or rank; see touchdown --help"),
        (["run", "a", "b"], "touchdown run takes no argument b here; see touchdown run --help"),
        (
            ["run", "a", "--durashon=3"],
            "has no option --durashon=3; did you mean --duration; see touchdown run --help",
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
