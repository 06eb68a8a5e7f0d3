"""Verbs for FMUs and systems: what the command prints of them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ...master.common.errors import FAILED, TouchdownError, as_list
from ...master.common.text import aligned, joined
from ...master.common.units import to_si
from ..api.fmus import build, built_one_by_one, check
from ..console import say_whose_code_runs
from ..parameters import Names, PathLike, Texts, Time

if TYPE_CHECKING:
    from ...master.common.cache import Entry
    from ...master.scene.scene import Scene


@wraps(build)
def show_build(**options: Any) -> int:
    """Print each file when it is there."""
    for path in built_one_by_one(**options):
        print(path, flush=True)
    return 0


def show_check(
    fmus: Texts = (),
    *,
    role: Literal["bearing", "rotor", "amb", "housing", "controller"] | None = None,
    names: PathLike | None = None,
    call_timeout: Time | None = None,
    sample_time: Time | None = None,
    unused_for: str | None = None,
    clear: bool = False,
) -> int:
    """Check FMUs: validity, contract, forces, the model's results; without one, this host, or the cache.

    fmus: paths of .fmu files, or names of the project's own; cache: what is kept between runs (default:
        what their host needs here)
    names: TOML: the FMU's own names for the variables of the contract
    unused_for: with cache: remove what was not used for so many days
    clear: with cache: remove everything that can be made again; runs under way will fail
    """
    of_cache = list(fmus) == ["cache"]
    of_fmus = {"as": role, "names": names, "call-timeout": call_timeout, "sample-time": sample_time}
    asked = joined(f"--{name}" for name, value in of_fmus.items() if value is not None)
    if asked and (of_cache or not fmus):
        raise TouchdownError(f"{asked}: such options are for an FMU; name one")
    if of_cache:
        return _check_cache(unused_for, clear)
    if clear or unused_for is not None:
        raise TouchdownError("--clear and --unused-for are of the cache: touchdown check cache")
    if not fmus:  # before imports that need numba, of which it tells where it compiles nothing
        return _check_host()

    from ...master.components.loading import foreign
    from ...master.scene.file import read_names

    called = read_names(Path(names)) if names else {}
    say_whose_code_runs([name for name in fmus if foreign(name)])
    failed = 0
    for name in fmus:
        report = check(name, role, called, call_timeout, sample_time)
        print(report.text, flush=True)
        failed += bool(report.problems)
    return FAILED if failed else 0


def _check_host() -> int:
    """Print what a host of the FMUs needs on this machine; FAILED where something is missing."""
    from ...master.interop.host_needs import advice, examine

    good = True
    for finding in examine():
        print(finding.line, flush=True)
        good = good and finding.good
    print(advice())
    return 0 if good else FAILED


def show_ssp(
    scene: Scene,
    path: PathLike | None = None,
    *,
    outputs_only: bool = False,
    native: bool = False,
    targets: Names = (),
) -> int:
    """Write a scene as an SSP package, for other tools.

    path: of the package
    outputs_only: connect outputs only; constants such as inv_m are start values (for libcosim and others)
    native: its FMUs need no Python
    targets: machines that its native FMUs are for, all in one file (default: this one); FMUs given as files
        are packed unchanged
    """
    from ...master.interop.ssp.write import write_ssp

    where = Path(path or f"{scene.name}.ssp")
    package = write_ssp(scene, where, outputs_only, native, list(as_list(targets)))
    print(
        f"{package.path}: {package.components} components, {package.connections} connections, "
        f"macro step {scene.run.macro_step:g} s"
    )
    if package.fixed:
        names = ", ".join(package.fixed)
        print(f"in tools that set no values, FMUs given as files start from their own: {names}")
    return 0


def _check_cache(unused_for: str | None, clear: bool) -> int:
    """Show what is kept between runs, and clean up."""
    from ...master.common.cache import cache_entries, rebuildable, remove_entries, stale
    from ...modelkit.kernel.cache_folder import is_cache, user_cache

    if clear and unused_for is not None:
        raise TouchdownError("--clear and --unused-for exclude each other; give one")
    root = user_cache()
    try:
        held = cache_entries(root)
    except OSError as error:  # something went meanwhile
        raise TouchdownError(f"cannot look at {error.filename}: {error.strerror}; try again") from None
    print("\n".join(_table(str(root), held)))
    if not clear and unused_for is None:
        return 0
    if not is_cache(root):
        raise TouchdownError(f"{root} holds other things than the cache; remove by hand what is to go")
    chosen = rebuildable(held) if clear else stale(held, time.time(), _days(unused_for or "0"))
    try:
        freed = remove_entries(chosen)
    except OSError as error:
        raise TouchdownError(f"cannot remove {error.filename}: {error.strerror}") from None
    print(f"removed {len(chosen)} of {len(held)}, {freed / 1e6:.1f} MB")
    return 0


def _table(root: str, held: Sequence[Entry]) -> list[str]:
    """The contents of the cache, a line for each kind."""
    from ...master.common.cache import DAY, DESCRIPTIONS

    current_time = time.time()
    rows: list[tuple[str, ...]] = []
    for kind, about in [*DESCRIPTIONS.items(), ("in all", "")]:
        if entries := [entry for entry in held if entry.kind == kind or not about]:
            unused = max(current_time - entry.used for entry in entries) / DAY
            note = f"{about}; unused for {unused:.0f} days at most" if about else ""
            rows.append((kind, str(len(entries)), f"{sum(one.size for one in entries) / 1e6:.1f} MB", note))
    return [root, *aligned(rows, "<>><", "  ")]


def _days(text: str) -> float:
    days = to_si(text.removesuffix("days").removesuffix("d"), "1", "--unused-for")
    if days < 0.0:
        raise TouchdownError(f"--unused-for {text} must not be negative")
    return days
