"""FMUs as files: build the project's own, check anyone's."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from touchdown.fmus import build as builder
from touchdown.fmus.python.link import LinkError, interpreter
from touchdown.fmus.recipes import Recipe, names
from touchdown.master.api.scenes import PathLike
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import writing_to
from touchdown.master.common.several import several
from touchdown.master.components.library import locate
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.contract import Report
from touchdown.master.scene.run_spec import CALL_TIMEOUT


def build(
    fmus: PathLike | Iterable[PathLike] | None = None,
    folder: PathLike = "build",
    *,
    link_python: bool = False,
) -> list[Path]:
    """Build FMUs of the project's by name, or of rotors by the paths of their files; None: all.

    Returns the files, NAME.fmu in `folder`. link_python: for hosts without Python on this machine.
    Raises TouchdownError for an unknown name, and where the folder cannot be written.

    >>> touchdown.build(["bushing"], "build")
    [PosixPath('build/bushing.fmu')]
    """
    recipes = [_recipe(os.fspath(fmu)) for fmu in (names() if fmus is None else several(fmus))]
    try:
        linked = interpreter() if link_python else None
        with writing_to(Path(folder)):
            return [builder.build(recipe, Path(folder), linked) for recipe in recipes]
    except LinkError as error:
        raise TouchdownError(str(error)) from None


def check(
    fmu: PathLike,
    role: str | None = None,
    names: Mapping[str, str] | None = None,
    call_timeout: float = CALL_TIMEOUT,
) -> Report:
    """Check the FMU at a path, or one of the project's by name: valid, what it has ports for, a dry run.

    role: "bearing", "rotor", "amb" or "housing", whether it can stand in for one; names: what it calls the
    variables of the contract. An FMU at a path runs in a process of its own, where each call may take
    call_timeout (s). The report's `problems` are empty where all is well. Raises TouchdownError
    where there is nothing to check.

    >>> touchdown.check("bushing", role="bearing").problems
    []
    """
    return check_fmu(os.fspath(fmu), role, names, call_timeout)


def _recipe(name: str) -> Recipe:
    recipe = locate(name)
    if not isinstance(recipe, Recipe):
        raise TouchdownError(f"{name} is an FMU already; give the name of one or a rotor's .toml")
    return recipe
