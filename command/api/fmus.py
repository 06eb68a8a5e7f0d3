"""FMUs as files: build the project's own, check anyone's."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ...master.common.errors import TouchdownError, as_list
from ..parameters import Counts, Names, PathLike, Settings, Texts, Time

if TYPE_CHECKING:
    from ...fmus.recipes import Recipe
    from ...master.interop.contract import CheckReport


def build(
    fmus: Texts | PathLike | None = None,
    folder: PathLike = "build",
    *,
    native: bool = False,
    fmi: Literal[2, 3] = 2,
    targets: Names = (),
    modes: Counts | None = None,
) -> list[Path]:
    """Build the FMUs.

    fmus: FMUs to build, rotor files (.toml), or models in C (.py, which is run) (default: all)
    folder: for the files, NAME.fmu
    native: FMUs that need no Python; others have pythonfmu's libraries for 64-bit Linux and Windows (the
        one for Windows was not run), and need Python with numpy, scipy and numba
    fmi: version of FMI; 3.0 with --native only
    targets: machines that native FMUs are for, all in one file (default: this one)
    modes: modes per plane that rotors start with, the two rigid ones included; seats have connectors for
        what they then carry (2: none; 0: all); native rotors hold constants for several, N,N,... (default:
        2,5,10), and start with the most

    Returns the files. Raises TouchdownError for an unknown name, modes that a rotor does not have, where
    the folder cannot be written, and where a compiler is missing.

    >>> touchdown.build(["bushing"], "build")
    [PosixPath('build/bushing.fmu')]
    """
    return list(built_one_by_one(fmus, folder, native, fmi, targets, modes))


def built_one_by_one(
    fmus: Texts | PathLike | None,
    folder: PathLike,
    native: bool = False,
    fmi: int = 2,
    targets: Names = (),
    modes: Counts | None = None,
) -> Iterator[Path]:
    """`build_native`, each file when it is there."""
    from ...fmus import build as builder
    from ...fmus.native.compiler import NativeError, chosen_targets
    from ...fmus.native.interfaces import FMI_2, INTERFACES
    from ...fmus.native.native_build import MODES, Native, build_native, compile_kernels
    from ...fmus.recipes import fmu_names
    from ...master.common.files import writing_to

    if fmi not in INTERFACES:
        raise TouchdownError(f"there is no FMI {fmi} to build for; choose 2 or 3")
    if fmi != FMI_2.version and not native:
        raise TouchdownError("pythonfmu's FMUs are of FMI 2.0; add --native for FMI 3.0")
    machines = list(as_list(targets))
    if machines and not native:
        raise TouchdownError("--target is for native FMUs; add --native")
    counts = None if modes is None else _counts(as_list(modes))
    where = Path(folder)
    try:
        chosen = fmu_names() if fmus is None else as_list(fmus)
        recipes = _for_modes([_recipe(os.fspath(fmu), native) for fmu in chosen], counts, native)
        kit = None
        if native:  # the kernels of all are compiled beside each other first
            kit = Native(chosen_targets(machines), counts or MODES, counts is None, INTERFACES[fmi])
            kit.check()
            compile_kernels(recipes)
        with writing_to(where):
            for recipe in recipes:
                yield build_native(recipe, where, native=kit) if kit else builder.build_fmu(recipe, where)
    except NativeError as error:
        raise TouchdownError(str(error)) from None


def _counts(modes: Sequence[int | str]) -> tuple[int, ...]:
    """Numbers of modes. Raises TouchdownError where one is not a whole number."""
    try:
        return tuple(int(count) for count in modes)
    except ValueError:
        shown = ",".join(map(str, modes))
        raise TouchdownError(
            f"--modes {shown}: give whole numbers with commas between, as in 2,5"
        ) from None


def _for_modes(recipes: list[Recipe], modes: tuple[int, ...] | None, native: bool) -> list[Recipe]:
    """The recipes for the largest of some numbers of modes; bearings fit all rotors among them.

    Raises TouchdownError where a rotor does not have so many.
    """
    from ...fmus.variants import ALL, RIGID, modes_listed
    from ...modelkit.model import ModelError

    if modes is None:
        return recipes
    if not modes or any(count < RIGID and count != ALL for count in modes):
        raise TouchdownError(f"modes = {list(modes)}: give {RIGID} (rigid) or more, or {ALL} for all")
    if len(modes) > 1 and not native:
        raise TouchdownError(
            f"modes = {list(modes)}: an FMU in Python takes any number of modes; give the one to start with"
        )
    count = ALL if ALL in modes else max(modes)
    rotors = [recipe for recipe in recipes if recipe.model.tabulated]
    try:
        listed = modes_listed(count, [rotor.model for rotor in rotors])
    except ModelError as error:
        raise TouchdownError(str(error)) from None
    return [recipe.with_modes(count, listed) for recipe in recipes]


def check(
    fmu: PathLike,
    role: Literal["bearing", "rotor", "amb", "housing", "controller"] | None = None,
    names: Settings | None = None,
    call_timeout: Time | None = None,
    sample_time: Time | None = None,
) -> CheckReport:
    """Check an FMU: valid, what it has ports for, a dry run, and for one that the project made, the results
    of the installed model.

    fmu: its path, or the name of one of the project's own
    role: the role that it takes in a scene
    names: its own names for the variables of the contract
    call_timeout: longest time that a call of an .fmu, which runs in a process of its own, may take
        (default: 60 s)
    sample_time: time between the samples of a controller (default: its FMU's fixed step, or 100 us)

    The report's `problems` are empty where all is well. Raises TouchdownError where there is nothing to
    check.

    >>> touchdown.check("bushing", role="bearing").problems
    []
    """
    from ...master.interop.check import check_fmu
    from ...master.scene.run_spec import CALL_TIMEOUT
    from ...master.scene.tables import positive_value

    timeout = CALL_TIMEOUT if call_timeout is None else positive_value(call_timeout, "s", "call_timeout")
    sample = positive_value(sample_time, "s", "sample_time") if sample_time else 0.0
    return check_fmu(os.fspath(fmu), role, names or {}, timeout, sample)


def _recipe(name: str, native: bool) -> Recipe:
    from ...fmus.native.in_c import recipe_in_c
    from ...fmus.recipes import Recipe
    from ...master.components.loading import locate_fmu

    if name.endswith(".py"):
        if not native:
            raise TouchdownError(f"{name} declares a model in C, whose FMU is native; add --native")
        return recipe_in_c(Path(name))
    recipe = locate_fmu(name)
    if not isinstance(recipe, Recipe):
        raise TouchdownError(f"{name} is an FMU already; give the name of one or a rotor's .toml")
    return recipe
