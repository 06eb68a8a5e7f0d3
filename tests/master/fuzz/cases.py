"""Cases: what the command is asked to do with what was damaged. Equal numbers make equal cases.

`python tests/master/fuzz/cases.py FIRST COUNT [JOBS]` plays that many from number FIRST, prints what is
wrong, and a table of how they ended.
"""

from __future__ import annotations

import argparse
import atexit
import os
import shlex
import shutil
import sys
import tempfile
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from functools import cache
from pathlib import Path

import bases
import fmpy
import numpy as np
from fmpy import platform as fmi_platform
from fmpy import sharedLibraryExtension
from mutators import Rng, archive, arrays, damaged_archive, json_text, pick, recording, table, toml, value
from pool import Ran, inside, run_cases

from touchdown.command.api.run import open_result
from touchdown.command.cli import main
from touchdown.command.console import print_error
from touchdown.command.verbs import ALL
from touchdown.fmus.recipes import recipe
from touchdown.master.common.errors import FAILED, STOPPED, TouchdownError
from touchdown.master.common.text import aligned
from touchdown.master.interop.ssp.xml import SSD_FILE
from touchdown.master.results.result import RECORDING
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene, shipped_scenes
from touchdown.master.scene.run_spec import RunSpec
from touchdown.modelkit.model import slots
from touchdown.modelkit.variables import Causality
from touchdown.rotor.imports.arrays import read_folder
from touchdown.studies.sweep.definition import DEFINITION_FILE, define
from touchdown.studies.sweep.design import Design
from touchdown.studies.sweep.members import MEMBERS_FILE, Journal, Member
from touchdown.studies.sweep.report import short_table, whole_table
from touchdown.studies.sweep.results import read

ROOT = Path(__file__).parents[3]
SEED = 2026
MOST_MEMORY = 1e9  # bytes of a case
QUIET = ("--in-process", "--no-pictures", "--quiet", "-o", "out")
SCENE = "disk-caged-simplified"
COMPONENTS = ("rotor", "amb", "bearing", "housing")
SHORT = ("duration = 5.0", "duration = 1e-4")
EARLY = ('shutdown_time = "5 ms"', "shutdown_time = 0")


def scene(rng: Rng) -> list[str]:
    """A scene's file."""
    text = shipped_scenes()[SCENE].read_text(encoding="utf-8")
    for before, after in (SHORT, EARLY):
        text = text.replace(before, after)
    Path("scene.toml").write_bytes(toml(rng, text))
    return _asked(rng, "scene.toml", COMPONENTS)


def rotor(rng: Rng) -> list[str]:
    """A rotor's file, in a scene that is right."""
    Path("scene.toml").write_text(bases.TURNING, encoding="utf-8")
    Path("rotor.toml").write_bytes(toml(rng, bases.ROTOR))
    return _asked(rng, "scene.toml", ("rotor",))


def _asked(rng: Rng, path: str, components: tuple[str, ...]) -> list[str]:
    """What may be asked of a scene, the quick more often."""
    chosen = rng.random()
    if chosen < 0.25:
        return ["run", path, *QUIET]
    if chosen < 0.6:
        return ["scenes", path, "--variables", pick(rng, components)]
    return pick(rng, (["scenes", path], ["scenes", path], ["compare", "--of", "steps", path, "-o", "out"]))


def setting(rng: Rng) -> list[str]:
    """Settings of a scene, by options."""
    bearing = pick(rng, BEARINGS)
    models = {"rotor": "rigid_rotor", "amb": "amb", "housing": "housing", "bearing": bearing}
    names = [f"{name}.{variable}" for name, fmu in models.items() for variable in _parameters(fmu)]
    names.remove("amb.shutdown_time")  # hours until it are hours of work
    given: list[str] = []
    for _ in range(int(rng.integers(1, 3))):
        name = pick(rng, names if rng.random() < 0.7 else RUN)
        given += ["--set", f"{name}={value(rng)}"]
    brief = ["--set", "amb.shutdown_time=0", "--set", "run.duration=1e-4"]
    return ["run", SCENE, "--swap", f"bearing={bearing}", *brief, *given, *QUIET]


@cache
def _parameters(fmu: str) -> list[str]:
    return [s.variable.name for s in slots(recipe(fmu).model) if s.causality is Causality.PARAMETER]


def options(rng: Rng) -> list[str]:
    """Options of all verbs, and what is none. One is always wrong, so that nothing long begins."""
    verb = ALL[int(rng.integers(len(ALL)))]
    parser = argparse.ArgumentParser()
    verb.declare(parser)
    known = [a for a in parser._actions if a.option_strings and a.dest != "help"]
    given: list[str] = []
    for _ in range(int(rng.integers(0, 4)) if known else 0):
        action = known[int(rng.integers(len(known)))]
        given += [action.option_strings[-1], *([value(rng)] if action.nargs != 0 else [])]
    scene = pick(rng, (SCENE, SCENE, *WRONG))
    wrong = pick(rng, ("--nosuch", "--set=x", "--jobs=0", "--set=run.macro_step=0"))
    return [verb.name, *([scene] if rng.random() < 0.9 else []), *given, wrong]


WRONG = ("nosuch", "", "x.toml", "/dev/null", "/", ".toml", "x.ssp", "/dev/full.toml", "é", "-", 999 * "x")


def package(rng: Rng) -> list[str]:
    """An SSP package."""
    content = {
        SSD_FILE: bases.STRUCTURE.encode(),
        "b.ssv": bases.VALUES.encode(),
        "resources/m.fmu": archive(FMU),
    }
    heart = pick(rng, (SSD_FILE, SSD_FILE, "b.ssv"))
    Path("scene.ssp").write_bytes(damaged_archive(rng, content, heart))
    return ["scenes", "scene.ssp"]


def fmu(rng: Rng) -> list[str]:
    """An FMU in a package that is right. Its library is never loaded: `scenes` reads what it declares."""
    content = {
        SSD_FILE: bases.STRUCTURE.encode(),
        "b.ssv": bases.VALUES.encode(),
        "resources/m.fmu": damaged_archive(rng, FMU, "modelDescription.xml"),
    }
    Path("scene.ssp").write_bytes(archive(content))
    return ["scenes", "scene.ssp"]


def cells(rng: Rng) -> list[str]:
    """A table of a rotor's sections, or of a mount's loop."""
    kind, name = ("rotor", "pump_sections") if rng.random() < 0.6 else ("mount", "mount_loop")
    text = (ROOT / "examples" / f"{name}.csv").read_text(encoding="utf-8")
    Path("table.csv").write_bytes(table(rng, "\n".join(text.splitlines()[:60])))
    return ["import", kind, "table.csv", *(["--slides", "1"] if kind == "mount" else []), *MADE]


def archives(rng: Rng) -> list[str]:
    """An archive of a rotor's matrices."""
    Path("rotor.npz").write_bytes(arrays(rng, _matrices()))
    return ["import", "rotor", "rotor.npz", *MADE]


@cache
def _matrices() -> dict[str, np.ndarray]:
    held = read_folder(ROOT / "examples" / "spindle_matrices", ("M", "K", "G"))
    return {name: np.asarray(value) for name, value in held.items() if value is not None}


def left(rng: Rng) -> list[str]:
    """A file of what a run or a sweep left."""
    folder = Path(shutil.copytree(_left(), "left"))
    files = ("summary.json", "ending.json", "scene.json", "sweep/sweep.json", "sweep/members.jsonl")
    file = folder / pick(rng, files)
    one, *others = file.read_bytes().splitlines() if file.suffix == ".jsonl" else [file.read_bytes()]
    file.write_bytes(b"\n".join([json_text(rng, one.decode()), *others, b""]))
    if file.name == "scene.json" and rng.random() < 0.3:
        return ["scenes", str(file)]
    return _looked_at(rng, file.parent)


def recorded(rng: Rng) -> list[str]:
    """A recording."""
    folder = Path(shutil.copytree(_left(), "left"))
    recording(rng, folder / RECORDING)
    return _looked_at(rng, folder)


def _looked_at(rng: Rng, folder: Path) -> list[str]:
    """A report, which takes seconds, now and then; else all that it would read."""
    if rng.random() < 0.15:
        return ["report", str(folder), "-o", "out/page.html"]
    return [LOOK, str(folder)]


@cache
def _left() -> Path:
    """A run's folder with a sweep's in it, made once by each process."""
    folder = Path(tempfile.mkdtemp(prefix="touchdown_left_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    scene = load_scene(SCENE).set({"run.duration": "1 ms", "amb.shutdown_time": 0.0})
    result = run_scene(scene, folder, in_process=True)
    result.recording.close()
    design = Design.grid({"rotor.mass": [1.0, 2.0]})
    asked = define(scene, design, in_process=True)
    (folder / "sweep").mkdir()
    asked.write(folder / "sweep")
    for number, settings in asked.by_number.items():
        Journal(folder / "sweep" / MEMBERS_FILE).add(Member(number, settings, result.summary))
    return folder


def look(folder: Path) -> int:
    """Read all that a run or a sweep left, as reports and tables do."""
    if (folder / DEFINITION_FILE).exists():
        found = read(folder)
        print(repr(found), found.data, found.counts, short_table(found.members), whole_table(found.members))
        return 0
    result = open_result(folder)
    try:
        print(repr(result), result.data.load(), result.to_pandas(), result._repr_html_(), result.ending)
        print([result.recording.at_end(name) for name, _ in result.recording.columns()])
        print([result.recording.about_column(name) for name, _ in result.recording.columns()])
    finally:
        result.recording.close()
    return 0


LOOK = "look"  # a verb of this module's own
MADE = ("-o", "out/made.toml")
LIBRARY = Path(fmpy.__file__).parent / "logging" / fmi_platform / f"logging{sharedLibraryExtension}"
FMU = {
    "modelDescription.xml": bases.DESCRIPTION.encode(),
    f"binaries/{fmi_platform}/m{sharedLibraryExtension}": LIBRARY.read_bytes(),
}
BEARINGS = (
    *("simplified_caged", "simplified_cageless", "detailed_caged", "detailed_cageless"),
    *("angular_caged", "angular_cageless", "bushing"),
)
RUN = tuple(f"run.{field.name}" for field in fields(RunSpec))
KINDS: tuple[Callable[[Rng], list[str]], ...] = (
    *(scene, setting, rotor, options, package, scene, rotor, fmu),
    *(cells, archives, left, recorded, left, recorded),
)


def prepared(case: int) -> list[str]:
    """The arguments of a case; the files that they name are made in the present folder."""
    return KINDS[case % len(KINDS)](np.random.default_rng([SEED, case]))


def play(case: int, folder: Path) -> int:
    """Play a case in the present folder, which is empty; returns the status it ended with.

    Raises AssertionError where files are written beside the folder out, or changed.
    """
    arguments = prepared(case)
    before = _files(folder)
    with _cache_in(folder / "cache"):
        try:
            status = look(Path(arguments[1])) if arguments[0] == LOOK else main(arguments)
        except SystemExit as end:  # argparse
            status = int(end.code or 0)
        except TouchdownError as error:
            print_error(str(error))
            status = FAILED
    changed = {str(path) for path in dict(_files(folder).items() ^ before.items())}
    assert not changed, f"written outside of out: {changed}"
    return status


def _files(folder: Path) -> dict[Path, tuple[int, int]]:
    """Sizes and times of all files but those of the cache and of the folder for results."""
    return {
        path: (found.st_size, found.st_mtime_ns)
        for path in folder.rglob("*")
        if path.relative_to(folder).parts[0] not in ("cache", "out") and not path.is_dir()
        for found in [path.lstat()]
    }


@contextmanager
def _cache_in(folder: Path) -> Generator[None]:
    """What is unpacked lies in `folder`; machine code, whose place is known by now, where it did."""
    before = os.environ.get("TOUCHDOWN_CACHE")
    os.environ["TOUCHDOWN_CACHE"] = str(folder)
    try:
        yield
    finally:
        os.environ.pop("TOUCHDOWN_CACHE")
        if before is not None:
            os.environ["TOUCHDOWN_CACHE"] = before


def wrong(ran: Ran) -> str:
    """What is wrong with how a case ended, or ""."""
    lines = ran.stderr.splitlines()
    if ran.status is None:
        return ran.stderr or "it was lost"
    if ran.memory > MOST_MEMORY:
        return f"it took {ran.memory / 1e6:.0f} MB"
    if ran.status not in (0, FAILED, STOPPED):
        return f"status {ran.status}: {ran.stderr}"
    if not all(line.startswith("touchdown: ") for line in lines):
        return f"stray lines: {ran.stderr}"
    told = [line for line in lines if not line.startswith("touchdown: warning: ")]
    if len(told) != (ran.status != 0):
        return f"status {ran.status} with {len(told)} lines: {ran.stderr}"
    return ""


def counted(ended: Sequence[Ran]) -> list[str]:
    """A table of how many cases of each kind ended how, the longest, and the most memory."""
    rows = [("kind", "cases", "worked", "refused", "stopped", "wrong", "longest", "memory")]
    by_kind = [(KINDS[ran.case % len(KINDS)].__name__, ran) for ran in ended]
    for kind in dict.fromkeys(kind.__name__ for kind in KINDS):
        own = [ran for name, ran in by_kind if name == kind]
        statuses = [ran.status for ran in own if not wrong(ran)]
        counts = [len(own), *map(statuses.count, (0, FAILED, STOPPED)), len(own) - len(statuses)]
        most = max((ran.seconds for ran in own), default=0.0), max((ran.memory for ran in own), default=0.0)
        rows.append((kind, *map(str, counts), f"{most[0]:.1f} s", f"{most[1] / 1e6:.0f} MB"))
    return aligned(rows, "<>")


if __name__ == "__main__":
    first, count, *jobs = map(int, sys.argv[1:])
    ended = run_cases(play, range(first, first + count), *jobs)
    for ran in ended:
        if found := wrong(ran):
            with tempfile.TemporaryDirectory() as folder, inside(folder):
                line = shlex.join(["touchdown", *prepared(ran.case)])
            print(f"case {ran.case}, {ran.seconds:.1f} s: {line[:300]}\n{found[-1500:]}\n", flush=True)
    print("\n".join(counted(ended)))
