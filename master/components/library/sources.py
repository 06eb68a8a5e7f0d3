"""Where a component's FMU comes from: a file, the project's own recipes, or a rotor file."""

from __future__ import annotations

from pathlib import Path

from touchdown.fmus.build import cached
from touchdown.fmus.recipes import Recipe, names, presets, recipe
from touchdown.master.common.cache import tidy
from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.scene.scene import is_file
from touchdown.master.scene.tables import mistake_in
from touchdown.modelkit.model import ModelError


def locate(fmu: str, folder: Path = Path()) -> Path | Recipe:
    """The path of an .fmu, or the recipe of one of the project's own or of a rotor file (.toml).

    Relative paths start in `folder`. Raises TouchdownError where there is none, or it has a mistake.
    """
    if "\0" in fmu:
        raise TouchdownError(f"no FMU can be called {fmu!r}")
    if fmu.endswith(".toml"):
        try:
            return recipe(str(folder / fmu))
        except ModelError as error:
            raise TouchdownError(mistake_in(folder / fmu, error)) from None
    if foreign(fmu):
        return folder / fmu
    known = names()
    if fmu not in known and fmu in presets():
        raise TouchdownError(
            f"{fmu} is a bearing of the catalogue, no FMU; take it by --set COMPONENT.preset={fmu}"
        )
    if fmu not in known:
        raise TouchdownError(
            f"there is no FMU called {fmu}; {one_of(fmu, known)}, or give the path of an .fmu or of a "
            "rotor's .toml"
        )
    return recipe(fmu)


def foreign(fmu: str) -> bool:
    """Whether `fmu` is a file that brings code of its own, and none of the project's."""
    return is_file(fmu) and not fmu.endswith(".toml")


def built(recipe: Recipe, native: bool = False) -> Path:
    """The FMU of a recipe, built if it is not there; native: the one that needs no Python.

    Raises TouchdownError where it cannot be written or, native, cannot be built here.
    """
    try:
        path = _native(recipe) if native else cached(recipe)
    except OSError as error:
        raise TouchdownError(f"cannot build {recipe.name}.fmu: {error.strerror or error}") from None
    tidy()
    return path


def _native(recipe: Recipe) -> Path:
    from touchdown.fmus.native.build import cached as cached_native  # what compiles is for those who ask
    from touchdown.fmus.native.targets import NativeError

    try:
        return cached_native(recipe)
    except NativeError as error:
        raise TouchdownError(str(error)) from None
