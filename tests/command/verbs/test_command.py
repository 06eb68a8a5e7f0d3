"""The command's own help, version and completion."""

from __future__ import annotations

import argparse
import os
import platform
import re
import shlex
import subprocess
from itertools import product
from pathlib import Path
from typing import Literal

import pytest
from commands import Command
from places import COMMAND, ROOT

import touchdown
from touchdown.command.cli import _Parser, main, parser
from touchdown.command.options import Verb, called
from touchdown.command.parameters import METAVARS, POSITIVE, SIGNED, Length, Places, Times, read
from touchdown.command.verbs import ALL
from touchdown.fmus.model_names import models
from touchdown.fmus.version import VERSION
from touchdown.master.common.errors import TouchdownError
from touchdown.master.quantities import Group, quantities
from touchdown.master.scene.file import shipped_scenes
from touchdown.studies.rotor import whirl_figure

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
    if scene in ("my-machine/required.toml", "runs/sweep-rotor1-9000"):  # none that is shipped is such
        assert verb.name in ("rank", "run")
    elif scene:
        for build in verb.builders.values():
            called(build, values)


def test_the_verbs_are_few_and_every_option_has_its_help() -> None:
    options = [option for verb in ALL for option in verb.options().values()]
    assert len(ALL) <= 23
    assert len({option.name for option in options}) <= 100
    assert all(option.meaning for option in options)


def test_the_quantities_are_listed_by_groups(capsys: pytest.CaptureFixture[str]) -> None:
    """Each once, with what it is of, its units and its words."""
    assert main(["scenes", "--quantities"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["of", "SI", "read", "in"]
    assert [line for line in lines if not line.startswith(" ")] == list(Group)
    assert len(lines) == 1 + len(Group) + len(quantities())
    (stress,) = (line.split() for line in lines if line.split()[0] == "peak_bending_stress")
    assert stress[1:] == ["component", "Pa", "MPa", "largest", "bending", "stress"]


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
    options = command.parse_args(
        shlex.split("probe x 2mm --times 5,1s --kind 3 --at A=1,B=2 --no-drawn --quiet")
    )
    assert options.execute(options) == [["x"], "2mm", [1.0, 5.0], 3, {"A": "1", "B": "2"}, False, 7, False]
    for text, said in (("0 mm", "GAP 0 mm must be above 0"), ("1 kg", "it is measured in m")):
        options = command.parse_args(["probe", "x", text])
        with pytest.raises(TouchdownError, match=said):
            options.execute(options)
    assert verb.options()["gap"].meaning == "of it, on two lines"
    assert "--unseen" not in options.help_text()


ABOVE, WHOLE = "must be above 0", "must be a whole number above 0"
UNLIKE = "has the unit K; it is measured in"
NONE, NAN, LACKS = "is not a number", "is not a finite number", "a value is missing"
REFUSED: dict[str, dict[str, str]] = {  # texts by kind, and what is said of them
    **{kind: {"0": ABOVE, "-1": ABOVE, "nan": NAN, "1 K": UNLIKE, "": NONE} for kind in POSITIVE},
    **{kind: {"nan": NAN, "1 K": UNLIKE, "x": NONE, "": NONE} for kind in SIGNED},
    "Count": {"0": WHOLE, "-1": WHOLE, "1.5": WHOLE, "nan": NAN, "1 K": UNLIKE, "10001": "at most 10000"},
    "Points": {"0": WHOLE, "1.5": WHOLE, "100001": "at most 100000"},
    "Jobs": {"0": WHOLE, "-1": WHOLE, "257": "at most 256", "tcp": NONE},
    "Times": {"1,0 s": ABOVE, "1,K": NONE, "": LACKS},
    "Spins": {"1,2 K": UNLIKE, "nan": NAN, "": LACKS},
    "Names": {"": "is empty", "a,,b": "a name is missing"},
}
WRITE = "write NAME=VALUE"
LISTED: dict[str, dict[str, str]] = {
    "Settings": {"a": WRITE, "=1": WRITE},
    "Places": {"A": WRITE, "A=": WRITE, "A=1,A=2": "A is there twice"},
}
ANY = {"str", "Counts", "Texts", "PathLike"}  # whose texts the functions read


@pytest.mark.parametrize(
    ("kind", "text", "said"),
    [
        *((kind, text, said) for kind, texts in REFUSED.items() for text, said in texts.items()),
        *((kind, [text], said) for kind, texts in LISTED.items() for text, said in texts.items()),
    ],
)
def test_a_text_that_a_kind_cannot_be_is_refused(kind: str, text: str, said: str) -> None:
    with pytest.raises(TouchdownError, match=rf"^--it\b.*{re.escape(said)}") as refused:
        read(kind, text, "--it")
    assert "\n" not in str(refused.value)


def test_a_text_may_be_set_to_nothing() -> None:
    assert read("Settings", ["table.file=", "rotor.mass = 1 kg"], "--set") == {
        "table.file": "",
        "rotor.mass": "1 kg",
    }


def test_every_kind_has_texts_that_it_refuses() -> None:
    assert {*METAVARS, *POSITIVE, *SIGNED} == {*REFUSED, *LISTED, *ANY}


QUANTITIES = [
    option
    for verb in ALL
    for option in verb.options().values()
    if option.kind in {*POSITIVE, *SIGNED} and not option.positional
]


def test_a_quantity_may_begin_with_a_minus() -> None:
    for option, text in product(QUANTITIES, ("-9e2", "-.5", "-3 Unit")):
        command = _Parser()
        option.add_to(command, "")
        assert getattr(command.parse_args([option.flag, text]), option.name) == text


@pytest.mark.parametrize(
    "words",
    [["run"], ["sweep", "--vary=rotor.mass=1,2 kg"], ["verdict"], ["whirl"], ["rank", "--bearings=6014"],
     ["amb-margins"], ["compare"]],
    ids=lambda words: words[0],
)  # fmt: skip
def test_it_is_said_whose_code_runs(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = tmp_path / "own.fmu"
    broken.touch()
    name, *others = words
    arguments = ["disk-caged-simplified", f"--swap=bearing={broken}", f"-o={tmp_path / 'out'}", *others]
    assert main([name, *arguments]) != 0
    assert "runs code from files: bearing\n" in capsys.readouterr().out


def test_a_folder_that_cannot_be_written_is_refused_before_a_mount_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(whirl_figure, "predict", lambda *_: pytest.fail("it computes"))
    (tmp_path / "file").touch()
    arguments = ["--vary=housing_*.stiffness=2,3 MN/m", "-o", str(tmp_path / "file" / "x")]
    assert main(["whirl", "rotor1-9000", *arguments]) == 2
    assert "cannot write to" in capsys.readouterr().err


@pytest.mark.parametrize("verb", ALL, ids=lambda verb: verb.name)
def test_help_shows_the_examples_as_they_are_typed(verb, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([verb.name, "--help"])
    text = capsys.readouterr().out
    assert verb.examples
    for line in verb.examples:
        assert f"\n  {line}\n" in text
    assert not re.search(r"in Python|without one nothing|\bNone\b", " ".join(text.split()))


@pytest.mark.parametrize(
    ("old", "new", "example"),
    [
        ("import-rotor", "import rotor", ("pump_sections.csv", "--at", "A=50 mm,B=17")),
        ("import-mount", "import mount", ("mount_loop.csv",)),
    ],
)
def test_an_old_verb_does_what_it_did(
    old: str, new: str, example: tuple[str, ...], command: Command, tmp_path: Path
) -> None:
    path = tmp_path / "made.toml"
    given = (ROOT / "examples" / example[0], *example[1:], "-o", path)
    assert command(*new.split(), *given) == (0, "")
    made = path.read_bytes()
    path.unlink()
    note = f"touchdown: {old} is called {new} now\n"
    assert command(old, *given) == (0, note)
    assert path.read_bytes() == made
    path.write_text("another file", encoding="utf-8")
    assert command(old, *given).status == 2
    assert command(old, *given, "--force") == (0, note)


@pytest.mark.parametrize("old", [("--macro-step", "20 us"), ("--macro-step=20 us",)])
def test_a_macro_step_as_it_was_given_is_taken(
    old: tuple[str, ...], command: Command, tmp_path: Path
) -> None:
    short = ("disk-caged-simplified", "--duration", "1 ms", "--in-process", "--quiet", "--no-pictures")
    note = "touchdown: --macro-step TIME is called --set run.macro_step=TIME now\n"
    assert command("run", *short, "-o", tmp_path, *old) == (0, note)
    assert touchdown.open_result(tmp_path).scene.run.macro_step == pytest.approx(20e-6)
    assert "has no option --macro-step" in command("verdict", "x", *old).line


def test_isolate_and_a_report_that_goes_are_told(
    command: Command, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = ("disk-caged-simplified", "--duration", "1 ms", "--in-process", "--quiet", "--no-pictures")
    code, said = command("run", *short, "-o", tmp_path, "--isolate")
    assert (code, said.count("\n")) == (0, 1)
    assert "--isolate does nothing now" in said
    (tmp_path / "report.html").touch()
    assert main(["run", *short, "-o", str(tmp_path)]) == 0
    said = f"{tmp_path} has an earlier run: report.html go once this one begins"
    assert said in capsys.readouterr().out
    assert not (tmp_path / "report.html").exists()


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
    environment = os.environ | asked
    ended = subprocess.run(COMMAND, env=environment, capture_output=True, text=True, timeout=60, check=True)
    imported = {row.rpartition("|")[2].strip().partition(".")[0] for row in ended.stderr.splitlines()}
    assert "argcomplete" in imported
    return [word.strip() for word in answer.read_text(encoding="utf-8").splitlines()], imported


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("touchdown ru", ["run"]),
        ("touchdown run dis", [name for name in shipped_scenes() if name.startswith("dis")]),
        (
            "touchdown run rotor1-9000 --swap bearing_A=det",
            [f"bearing_A={n}" for n in models() if n[:3] == "det"],
        ),
        ("touchdown sweep rotor1-9000 --set rotor.mod", ["rotor.modes="]),
    ],
)
def test_completion_offers_what_there_is_and_imports_nothing_slow(
    line: str, wanted: list[str], tmp_path: Path
) -> None:
    offered, imported = tab(line, tmp_path)
    assert wanted
    assert sorted(offered) == sorted(wanted)
    assert not imported & SLOW


def test_what_a_file_says_reaches_the_terminal_escaped(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """On stdout as on stderr; long lines are cut there, and what others write later is left alone."""
    evil = r"\u001b]0;owned\u0007\u001b[31mred\u202e\u009b" + 9000 * "x"
    (tmp_path / "m.toml").write_text(f'extends = "disk-caged-simplified"\ntitle = "{evil}"\n')
    assert main(["scenes", str(tmp_path / "m.toml")]) == 0
    out = capsys.readouterr().out
    assert r"\x1b]0;owned\x07\x1b[31mred\u202e\x9bxxx" in out
    assert all(line.replace("\t", "").isprintable() and len(line) < 5000 for line in out.splitlines())
    (tmp_path / "n.toml").write_text(f'extends = "{evil}"\n')
    assert main(["scenes", str(tmp_path / "n.toml")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.isprintable()
    assert len(line) < 5000
    print("\x1b[0m")
    assert capsys.readouterr().out == "\x1b[0m\n"
