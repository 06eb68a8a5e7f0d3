"""Finds the FMU or model of a component, and loads it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...fmus.build import cached_fmu, is_sealed
from ...fmus.python.packed_sources import content_hash
from ...fmus.recipes import Recipe, fmu_names, is_law, presets, recipe
from ...modelkit.kernel.cache_folder import user_cache
from ...modelkit.model import Model
from ..common.cache import remove_stale
from ..common.errors import TouchdownError, one_of
from ..scene.run_spec import CALL_TIMEOUT
from ..scene.scene import is_file
from .component import Component
from .fmu import ArchivedFmu
from .fmu3 import load_fmu
from .in_process import InProcessComponent
from .isolation.isolated import IsolatedFmu
from .unpack import unpack

TABLE_REMEDY = "`python -m pythonfmu buildcsv -f TABLE.csv -d .` makes an FMU of a table over time"
MODES = "modes"  # setting of a rotor, on which its constants depend


def locate_fmu(fmu: str, folder: Path = Path()) -> Path | Recipe:
    """The path of an .fmu, or the recipe of one of the project's own, or of a rotor's or controller's file.

    Relative paths start in `folder`. Raises TouchdownError where it is missing or has a mistake.
    """
    if "\0" in fmu:
        raise TouchdownError(f"no FMU can be called {fmu!r}")
    if fmu.endswith(".toml") or is_law(fmu):
        return recipe(str(folder / fmu))
    if fmu.lower().endswith(".csv"):
        raise TouchdownError(f"{fmu} is a table, not an FMU; {TABLE_REMEDY}")
    if foreign(fmu):
        return folder / fmu
    known = fmu_names()
    if fmu not in known and fmu in presets():
        raise TouchdownError(
            f"{fmu} is a bearing of the catalogue, no FMU; take it by --set COMPONENT.preset={fmu}"
        )
    if fmu not in known:
        raise TouchdownError(
            f"there is no FMU called {fmu}; {one_of(fmu, known)}, or give the path of an .fmu, of a "
            "rotor's .toml, or of a controller's .json, .npz or .mat"
        )
    return recipe(fmu)


def foreign(fmu: str) -> bool:
    """Whether `fmu` is a file with third-party code."""
    return is_file(fmu) and not fmu.endswith(".toml") and not is_law(fmu)


def built(
    recipe: Recipe, native: bool = False, modes: Sequence[int] = (), targets: Sequence[str] = ()
) -> Path:
    """The FMU of a recipe, built if needed; native: the FMU that needs no Python.

    modes: of a rotor; a native FMU holds constants for them. targets: machines that a native FMU is for
    (none: this one). Raises TouchdownError where it cannot be written or, native, cannot be built here.
    """
    try:
        path = _native(recipe, modes, targets) if native else cached_fmu(recipe)
    except OSError as error:
        raise TouchdownError(f"cannot build {recipe.name}.fmu: {error.strerror or error}") from None
    remove_stale()
    return path


def _native(recipe: Recipe, modes: Sequence[int], targets: Sequence[str]) -> Path:
    from ...fmus.native.compiler import NativeError
    from ...fmus.native.native_build import cached_native  # deferred: the compiler is slow to import

    try:
        return cached_native(recipe, modes, targets)
    except NativeError as error:
        raise TouchdownError(str(error)) from None


def native_at_hand(fmu: str, folder: Path, settings: Mapping[str, object]) -> bool:
    """Whether one of the project's own components has its native FMU built already, of present sources."""
    from ...fmus.native.native_build import is_at_hand

    try:
        source = locate_fmu(fmu, folder)
    except TouchdownError:  # loading reports the error
        return False
    if is_law(fmu) and isinstance(source, Recipe) and source.model.tabulated:
        return False  # its constants hang on settings, and are held for none but the defaults
    return isinstance(source, Recipe) and is_at_hand(source, modes_of(settings))


def modes_of(settings: Mapping[str, object]) -> tuple[int, ...]:
    """Numbers of modes in a rotor's settings, for which a native FMU holds constants."""
    asked = str(settings.get(MODES))  # a number, or text of --set
    return (int(asked),) if asked.isdecimal() else ()


@dataclass(frozen=True)
class Stepping:
    """Where a component is stepped."""

    in_process: bool = False  # the project's own: the model, without its FMU
    isolate: bool = True  # a third-party FMU in a file: in a separate process
    call_timeout: float = CALL_TIMEOUT  # s that a call of an isolated FMU may take
    native: bool = False  # the project's own: its FMU that needs no Python
    modes: tuple[int, ...] = ()  # of a rotor, for which a native FMU holds constants


def load_component(
    name: str, fmu: str, folder: Path = Path(), stepping: Stepping = Stepping()
) -> Component:
    """A component: an FMU, or, where asked for and possible, its model stepped in process."""
    source = locate_fmu(fmu, folder)
    component = _loaded(name, fmu, source, stepping)
    component.model = source.model if isinstance(source, Recipe) else _own_model(component)
    return component


def _own_model(component: Component) -> Model | None:
    """The model of an FMU in a file, where it is one of the project's own, made of the present sources."""
    if not isinstance(component, ArchivedFmu):
        return None
    script = re.compile(rf"(\w+)_{content_hash()}")  # Recipe.module
    stems = (path.stem for path in sorted((component.folder / "resources").glob("*.py")))
    recipes = [recipe(m[1]) for stem in stems if (m := script.match(stem)) and m[1] in fmu_names()]
    identifier = component.description.coSimulation.modelIdentifier  # a user's rotor may be called amb, too
    return next((known.model for known in recipes if known.identifier == identifier), None)


def _loaded(name: str, fmu: str, source: Path | Recipe, stepping: Stepping) -> Component:
    if isinstance(source, Recipe) and stepping.in_process:
        return InProcessComponent(name, source.model)
    path, origin = (
        (source, "") if isinstance(source, Path) else (built(source, stepping.native, stepping.modes), fmu)
    )
    if stepping.isolate and not origin:
        unpack(path, user_cache())  # raises where the archive is damaged
        if not is_sealed(path):
            return IsolatedFmu(name, path, user_cache(), stepping.call_timeout)
    return load_fmu(name, path, user_cache(), origin)
