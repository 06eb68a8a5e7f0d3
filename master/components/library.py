"""Where a component's FMU comes from: a file, the project's own recipes, or a rotor file."""

from __future__ import annotations

import os
from pathlib import Path

from touchdown.fmus.build import cached
from touchdown.fmus.recipes import Recipe, names, recipe
from touchdown.master.common.cache import tidy
from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.components.component import Component
from touchdown.master.components.fmu import FmuComponent
from touchdown.master.components.twin import TwinComponent
from touchdown.modelkit.kernel.cache_folder import user_cache
from touchdown.modelkit.model import ModelError


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


def load_component(name: str, fmu: str, folder: Path = Path(), in_process: bool = False) -> Component:
    """A component: an FMU, or, where asked for and possible, its model stepped in process."""
    source = locate(fmu, folder)
    if isinstance(source, Path):
        return FmuComponent(name, source, user_cache())
    if in_process:
        return TwinComponent(name, source.model)
    return FmuComponent(name, built(source), user_cache(), origin=fmu)


def built(recipe: Recipe) -> Path:
    """The FMU of a recipe, built if it is not there. Raises TouchdownError where that cannot be written."""
    try:
        path = cached(recipe)
    except OSError as error:
        raise TouchdownError(f"cannot build {recipe.name}.fmu: {error.strerror or error}") from None
    tidy()
    return path
