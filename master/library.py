"""Where a component's FMU comes from: a file, the project's own recipes, or a rotor file."""

from __future__ import annotations

import os
from pathlib import Path

from fmus.build import cached
from fmus.recipes import Recipe, names, recipe
from master.component import Component
from master.errors import TouchdownError, one_of
from master.fmi import FmuComponent
from master.twin import TwinComponent
from modelkit.kernel import user_cache
from modelkit.model import ModelError


def locate(fmu: str, folder: Path = Path()) -> Path | Recipe:
    """The path of an .fmu, or the recipe of one of the project's own or of a rotor file (.toml).

    Relative paths start in `folder`. Raises TouchdownError where there is none, or it has a mistake.
    """
    if fmu.endswith(".toml"):
        try:
            return recipe(str(folder / fmu))
        except ModelError as error:
            raise TouchdownError(str(error)) from None
    if fmu.endswith(".fmu") or os.sep in fmu:
        return folder / fmu
    known = names()
    if fmu not in known:
        raise TouchdownError(
            f"there is no FMU called {fmu}; {one_of(fmu, known)}, or give the path of an .fmu or of a "
            "rotor's .toml"
        )
    return recipe(fmu)


def load(name: str, fmu: str, folder: Path = Path(), in_process: bool = False) -> Component:
    """A component: an FMU, or, where asked for and possible, its model stepped in process."""
    found = locate(fmu, folder)
    if isinstance(found, Path):
        return FmuComponent(name, found, user_cache())
    if in_process:
        return TwinComponent(name, found.model)
    return FmuComponent(name, cached(found), user_cache(), origin=fmu)
