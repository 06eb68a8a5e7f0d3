"""Cases: what the command is asked to do with what was damaged. Equal numbers make equal cases.

`python tests/master/fuzz/cases.py FIRST COUNT` plays that many from number FIRST, and prints what is wrong.
"""

from __future__ import annotations

import argparse
import os
import shlex
import sys
import tempfile
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import fields
from functools import cache
from pathlib import Path

import bases
import fmpy
import numpy as np
from fmpy import platform as fmi_platform
from fmpy import sharedLibraryExtension
from mutators import Rng, archive, damaged_archive, pick, toml, value
from pool import Ran, inside, run_cases

from touchdown.command.cli import main
from touchdown.command.verbs import ALL
from touchdown.fmus.recipes import recipe
from touchdown.master.common.errors import FAILED, STOPPED
from touchdown.master.interop.ssp.xml import SSD_FILE
from touchdown.master.scene.file import shipped
from touchdown.master.scene.run_spec import RunSpec
from touchdown.modelkit.model import slots
from touchdown.modelkit.variables import Causality

SEED = 2026
QUIET = ("--in-process", "--no-pictures", "--quiet", "-o", "out")
SCENE = "disk-caged-simplified"
COMPONENTS = ("rotor", "amb", "bearing", "housing")
SHORT = ("duration = 5.0", "duration = 1e-4")
EARLY = ('shutdown_time = "5 ms"', "shutdown_time = 0")


def scene(rng: Rng) -> list[str]:
    """A scene's file."""
    text = shipped()[SCENE].read_text(encoding="utf-8")
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
    return pick(rng, (["scenes", path], ["scenes", path], ["compare", "--of", "steps", path]))


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
    *(scene, setting, rotor, options, package, scene, setting, rotor, options, fmu),
)


def prepared(case: int) -> list[str]:
    """The arguments of a case; the files that they name are made in the present folder."""
    return KINDS[case % len(KINDS)](np.random.default_rng([SEED, case]))


def play(case: int, folder: Path) -> int:
    """Play a case in the present folder, which is empty; returns the status it ended with."""
    arguments = prepared(case)
    with _cache_in(folder / "cache"):
        try:
            return main(arguments)
        except SystemExit as end:  # argparse
            return int(end.code or 0)


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
    if ran.status not in (0, FAILED, STOPPED):
        return f"status {ran.status}: {ran.stderr}"
    if not all(line.startswith("touchdown: ") for line in lines):
        return f"stray lines: {ran.stderr}"
    told = [line for line in lines if not line.startswith("touchdown: warning: ")]
    if len(told) != (ran.status != 0):
        return f"status {ran.status} with {len(told)} lines: {ran.stderr}"
    return ""


if __name__ == "__main__":
    first, count = map(int, sys.argv[1:])
    for ran in run_cases(play, range(first, first + count)):
        print(f"{KINDS[ran.case % len(KINDS)].__name__} {ran.status} {ran.seconds:.3f}", file=sys.stderr)
        if found := wrong(ran):
            with tempfile.TemporaryDirectory() as folder, inside(folder):
                line = shlex.join(["touchdown", *prepared(ran.case)])
            print(f"case {ran.case}, {ran.seconds:.1f} s: {line[:300]}\n{found[-1500:]}\n", flush=True)
