"""FMUs as files: build the project's own, check anyone's."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

from ...fmus import build as builder
from ...fmus.native.build import MODES, Native, prepare
from ...fmus.native.build import build as build_native
from ...fmus.native.compiler import NativeError, chosen
from ...fmus.native.in_c import recipe_in_c
from ...fmus.native.interfaces import FMI_2, INTERFACES, Interface
from ...fmus.recipes import Recipe, names
from ...fmus.variants import ALL, RIGID, modes_listed
from ...master.common.errors import TouchdownError, as_list
from ...master.common.files import writing_to
from ...master.components.loading import locate
from ...master.interop.check import check_fmu
from ...master.interop.contract import Report
from ...master.scene.run_spec import CALL_TIMEOUT
from ...modelkit.model import ModelError
from .run import PathLike


def build(
    fmus: PathLike | Iterable[PathLike] | None = None,
    folder: PathLike = "build",
    *,
    native: bool = False,
    targets: Iterable[str] = (),
    modes: Iterable[int] | None = None,
    fmi: int = 2,
) -> list[Path]:
    """Build FMUs of the project's by name, or of rotors by the paths of their files; None: all.

    Returns the files, NAME.fmu in `folder`. native: for hosts without Python, of the machines `targets`
    (none: this one's kind). modes: per plane, the two rigid ones included (0: all): rotors start with so
    many, and seats tell of what they then have; native rotors hold constants for each of them and start
    with the most. fmi: 2, or 3, native only.
    Raises TouchdownError for an unknown name, modes that a rotor does not have, where the folder cannot be
    written, and where a compiler is missing.

    >>> touchdown.build(["bushing"], "build")
    [PosixPath('build/bushing.fmu')]
    """
    return list(built_one_by_one(fmus, folder, native=native, targets=targets, modes=modes, fmi=fmi))


def built_one_by_one(
    fmus: PathLike | Iterable[PathLike] | None,
    folder: PathLike,
    *,
    native: bool,
    targets: Iterable[str],
    modes: Iterable[int] | None,
    fmi: int,
) -> Iterator[Path]:
    """`build`, each file when it is there."""
    if fmi not in INTERFACES:
        raise TouchdownError(f"there is no FMI {fmi} to build for; choose 2 or 3")
    if fmi != FMI_2.version and not native:
        raise TouchdownError("pythonfmu's FMUs are of FMI 2.0; add --native for FMI 3.0")
    try:
        given = names() if fmus is None else as_list(fmus)
        counts = None if modes is None else tuple(modes)
        recipes = _for_modes([_recipe(os.fspath(fmu), native) for fmu in given], counts, native)
        make = _native(recipes, targets, counts, INTERFACES[fmi]) if native else builder.build
        with writing_to(Path(folder)):
            for recipe in recipes:
                yield make(recipe, Path(folder))
    except NativeError as error:
        raise TouchdownError(str(error)) from None


def _for_modes(recipes: list[Recipe], modes: tuple[int, ...] | None, native: bool) -> list[Recipe]:
    """The recipes for the largest of some numbers of modes; bearings fit all rotors among them.

    Raises TouchdownError where a rotor does not have so many.
    """
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


def _native(
    recipes: Sequence[Recipe], targets: Iterable[str], modes: tuple[int, ...] | None, face: Interface
) -> Callable[[Recipe, Path], Path]:
    """How to build each of `recipes`, whose kernels are compiled beside each other first."""
    native = Native(chosen(list(as_list(targets))), modes or MODES, modes is None, face)
    native.check()
    prepare(recipes)
    return partial(build_native, native=native)


def check(
    fmu: PathLike,
    role: str | None = None,
    names: Mapping[str, str] | None = None,
    call_timeout: float = CALL_TIMEOUT,
    sample_time: float = 0.0,
) -> Report:
    """Check the FMU at a path, or one of the project's by name: valid, what it has ports for, a dry run,
    and for one that the project made, the results of the installed model.

    role: "bearing", "rotor", "amb", "housing" or "controller", whether it can stand in for one; names: what
    it calls the variables of the contract. A third-party FMU runs in a process of its own, where each call
    may take call_timeout (s). sample_time (s) is a controller's; 0: what its FMU states, or 100 us. The
    report's `problems` are empty where all is well. Raises TouchdownError where there is nothing to check.

    >>> touchdown.check("bushing", role="bearing").problems
    []
    """
    return check_fmu(os.fspath(fmu), role, names, call_timeout, sample_time)


def _recipe(name: str, native: bool) -> Recipe:
    if name.endswith(".py"):
        if not native:
            raise TouchdownError(f"{name} declares a model in C, whose FMU is native; add --native")
        return recipe_in_c(Path(name))
    recipe = locate(name)
    if not isinstance(recipe, Recipe):
        raise TouchdownError(f"{name} is an FMU already; give the name of one or a rotor's .toml")
    return recipe
