"""A component's FMU loaded, or its model in its place."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from touchdown.fmus.recipes import Recipe
from touchdown.master.common.processes.watched import watch
from touchdown.master.components.component import Component
from touchdown.master.components.fmu import FmuComponent
from touchdown.master.components.foreign import foreign_fmu
from touchdown.master.components.interface import by_other_pythonfmu
from touchdown.master.components.isolation.component import IsolatedFmu
from touchdown.master.components.library.sources import built, locate
from touchdown.master.components.twin import TwinComponent
from touchdown.master.scene.run_spec import CALL_TIMEOUT
from touchdown.modelkit.kernel.cache_folder import user_cache


@dataclass(frozen=True)
class Stepping:
    """Where a component is stepped."""

    in_process: bool = False  # the project's own: the model, without its FMU
    isolate: bool = False  # an FMU: in a process of its own
    call_timeout: float = CALL_TIMEOUT  # s that a call of an isolated FMU may take
    native: bool = False  # the project's own: its FMU that needs no Python


def load_component(
    name: str, fmu: str, folder: Path = Path(), stepping: Stepping = Stepping()
) -> Component:
    """A component: an FMU, or, where asked for and possible, its model stepped in process."""
    source = locate(fmu, folder)
    if isinstance(source, Recipe) and stepping.in_process:
        return TwinComponent(name, source.model)
    path, origin = (source, "") if isinstance(source, Path) else (built(source, stepping.native), fmu)
    if stepping.isolate or (not origin and by_other_pythonfmu(path, user_cache())):
        return IsolatedFmu(name, path, user_cache(), origin, stepping.call_timeout)
    if origin:
        return FmuComponent(name, path, user_cache(), origin)
    watch(f"code of others ran in it, such as that of {path}; isolate it to see where it ends")
    return foreign_fmu(name, path, user_cache())
