"""Verbs for FMUs and systems: build, check, ssp, cache."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import FAILED, TouchdownError
from ...master.common.units import to_si
from ...master.scene.run_spec import CALL_TIMEOUT
from . import completion
from .arguments import above_zero, add_native, add_output, add_scene, chosen_scene
from .completion import complete
from .verb import Verb, say_whose_code_runs

if TYPE_CHECKING:
    from ...master.common.cache import Entry


BUILD_EXAMPLES = (
    "touchdown build -o build",
    "touchdown build my-rotor.toml",
    "touchdown build simplified_caged rotor_I --modes 5 -o build/five-modes",
    "touchdown build --native -o build/native",
    "touchdown build housing --native --target linux-x86_64 windows-x86_64 -o build/native",
    "touchdown build housing --native --fmi 3 -o build/fmi3",
    "touchdown build --native examples/rubber_ring.py -o build/native",
)


def _declare_build(verb: argparse.ArgumentParser) -> None:
    names = verb.add_argument(
        "names",
        metavar="FMU",
        nargs="*",
        help="FMUs to build, rotor files (.toml), or models in C (.py, which is run) (default: all)",
    )
    complete(names, completion.fmus)
    add_output(verb, Path("build"))
    verb.add_argument("--native", action="store_true", help="FMUs that need no Python")
    verb.add_argument(
        "--fmi",
        type=int,
        choices=(2, 3),
        default=2,
        help="version of FMI; 3.0 with --native only (default: 2)",
    )
    targets = verb.add_argument(
        "--target",
        nargs="+",
        action="extend",
        default=[],
        metavar="TARGET",
        help="machines that native FMUs are for, all in one file (default: this one)",
    )
    complete(targets, completion.targets)
    verb.add_argument(
        "--modes",
        metavar="N",
        help="modes per plane that rotors start with, the two rigid ones included; seats have connectors "
        "for what they then carry (2: none); native rotors hold constants for several, N,N,... "
        "(default: 2,5,10)",
    )


def _execute_build(options: argparse.Namespace) -> int:
    from ..api.fmus import built_one_by_one

    if not options.native and options.target:
        raise TouchdownError("--target is for native FMUs; add --native")
    made = built_one_by_one(
        options.names or None,
        options.output,
        native=options.native,
        targets=options.target,
        modes=None if options.modes is None else _counts(options.modes),
        fmi=options.fmi,
    )
    for path in made:
        print(path, flush=True)
    return 0


def _counts(text: str) -> list[int]:
    """Numbers of modes in a text such as "2,5,10"."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise TouchdownError(f"--modes {text}: give whole numbers with commas between, as in 2,5") from None


BUILD = Verb("build", "build the FMUs", BUILD_EXAMPLES, _declare_build, _execute_build)


CHECK_EXAMPLES = (
    "touchdown check",
    "touchdown check simplified_caged",
    "touchdown check my-bearing.fmu --as bearing --names my-names.toml",
    "touchdown check amb_controller --as controller",
)


def _declare_check(verb: argparse.ArgumentParser) -> None:
    fmus = verb.add_argument(
        "fmus",
        metavar="FMU",
        nargs="*",
        help="paths of .fmu files, or names of the project's own (default: what their host needs here)",
    )
    complete(fmus, completion.fmus)
    roles = ("bearing", "rotor", "amb", "housing", "controller")
    verb.add_argument("--as", dest="role", choices=roles, help="the role that it takes in a scene")
    verb.add_argument(
        "--names",
        type=Path,
        metavar="FILE",
        help="TOML: the FMU's own names for the variables of the contract",
    )
    verb.add_argument(
        "--call-timeout",
        default=f"{CALL_TIMEOUT:g} s",
        metavar="TIME",
        help=f"longest time that a call of an .fmu may take (default: {CALL_TIMEOUT:g} s)",
    )
    verb.add_argument(
        "--sample-time",
        metavar="TIME",
        help="time between the samples of a controller (default: its FMU's fixed step, or 100 us)",
    )


def _execute_check(options: argparse.Namespace) -> int:
    if not options.fmus:  # before imports that need numba, of which it tells where it compiles nothing
        return _check_host(options)

    from ...master.components.loading import foreign
    from ...master.interop.check import check_fmu
    from ...master.scene.file import read_names

    names = read_names(options.names) if options.names else {}
    call_timeout = above_zero(options.call_timeout, "s", "--call-timeout")
    assert call_timeout is not None
    given = options.sample_time
    sample_time = above_zero(given, "s", "--sample-time") if given is not None else 0.0
    assert sample_time is not None
    say_whose_code_runs([name for name in options.fmus if foreign(name)])
    failed = 0
    for name in options.fmus:
        report = check_fmu(name, options.role, names, call_timeout, sample_time)
        print(report.text, flush=True)
        failed += bool(report.problems)
    return FAILED if failed else 0


def _check_host(options: argparse.Namespace) -> int:
    """Print what a host of the FMUs needs on this machine; FAILED where something is missing."""
    from ...master.interop.host import advice, examine

    if options.role or options.names or options.sample_time:
        raise TouchdownError("--as, --names and --sample-time are for an FMU; name one")
    good = True
    for finding in examine():
        print(finding.line, flush=True)
        good = good and finding.good
    print(advice())
    return 0 if good else FAILED


CHECK = Verb(
    "check",
    "check FMUs: validity, contract, forces, the model's results; without one, this host",
    CHECK_EXAMPLES,
    _declare_check,
    _execute_check,
)


SSP_EXAMPLES = (
    "touchdown ssp disk-caged-simplified -o disk.ssp",
    'touchdown ssp rotor1-9000 --scheme jacobi-lead --macro-step "5 us" --outputs-only',
    "touchdown ssp disk-caged-simplified --scheme jacobi-lead --outputs-only --native -o disk.ssp",
)


def _declare_ssp(verb: argparse.ArgumentParser) -> None:
    add_scene(verb)
    verb.add_argument(
        "--outputs-only",
        action="store_true",
        help="connect outputs only; constants such as inv_m are start values (for libcosim and others)",
    )
    add_native(verb)
    add_output(verb, "SCENE.ssp", "file")


def _execute_ssp(options: argparse.Namespace) -> int:
    from ...master.interop.ssp.write import write_package

    scene = chosen_scene(options)
    path = options.output or Path(f"{scene.name}.ssp")
    package = write_package(scene, path, options.outputs_only, options.native)
    print(
        f"{package.path}: {package.components} components, {package.connections} connections, "
        f"macro step {scene.run.macro_step:g} s"
    )
    if package.fixed:
        names = ", ".join(package.fixed)
        print(f"in tools that set no values, FMUs given as files start from their own: {names}")
    return 0


SSP = Verb(
    "ssp", "write a scene as an SSP package, for other tools", SSP_EXAMPLES, _declare_ssp, _execute_ssp
)


CACHE_EXAMPLES = (
    "touchdown cache",
    "touchdown cache --unused-for 7",
    "touchdown cache --clear",
)


def _declare_cache(verb: argparse.ArgumentParser) -> None:
    what = verb.add_mutually_exclusive_group()
    what.add_argument(
        "--unused-for", metavar="DAYS", help="remove what was not used for so many days (30 if not given)"
    )
    what.add_argument(
        "--clear",
        action="store_true",
        help="remove everything that can be made again; runs under way will fail",
    )


def _execute_cache(options: argparse.Namespace) -> int:
    from ...master.common.cache import entries, made_again, outworn, remove
    from ...modelkit.kernel.cache_folder import is_cache, user_cache

    root = user_cache()
    try:
        held = entries(root)
    except OSError as error:  # something went meanwhile
        raise TouchdownError(f"cannot look at {error.filename}: {error.strerror}; try again") from None
    print("\n".join(_table(str(root), held)))
    if not options.clear and options.unused_for is None:
        return 0
    if not is_cache(root):
        raise TouchdownError(f"{root} holds other things than the cache; remove by hand what is to go")
    chosen = made_again(held) if options.clear else outworn(held, time.time(), _days(options.unused_for))
    try:
        freed = remove(chosen)
    except OSError as error:
        raise TouchdownError(f"cannot remove {error.filename}: {error.strerror}") from None
    print(f"removed {len(chosen)} of {len(held)}, {freed / 1e6:.1f} MB")
    return 0


def _table(root: str, held: Sequence[Entry]) -> Iterator[str]:
    """The contents of the cache, a line for each kind."""
    from ...master.common.cache import DAY, DESCRIPTIONS

    now = time.time()
    yield root
    for kind, about in DESCRIPTIONS.items():
        own = [entry for entry in held if entry.kind == kind]
        if own:
            unused = max(now - entry.used for entry in own) / DAY
            yield f"{_line(kind, own)}  {about}; unused for {unused:.0f} days at most"
    yield _line("in all", held)


def _line(name: str, held: Sequence[Entry]) -> str:
    return f"  {name:<13}{len(held):>5}{sum(entry.size for entry in held) / 1e6:>10.1f} MB"


def _days(text: str) -> float:
    days = to_si(text.removesuffix("days").removesuffix("d"), "1", "--unused-for")
    if days < 0.0:
        raise TouchdownError(f"--unused-for {text} must not be negative")
    return days


CACHE = Verb(
    "cache", "show what is kept between runs, and clean up", CACHE_EXAMPLES, _declare_cache, _execute_cache
)
