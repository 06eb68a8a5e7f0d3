"""The FMUs of a scene's package, each of which starts from the values that its component has in the scene.

Not every tool reads a package's values; one that sets nothing then runs the same drop.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ....fmus.recipes import Recipe
from ...common.errors import TouchdownError
from ...components.component import FmiType
from ...components.fmu import ArchivedFmu
from ...components.loading import built, locate_fmu
from ...coupling.system import System
from ...scene.scene import Scene


def texts(system: System, name: str) -> dict[str, str]:
    """Strings that are set in a component, by the scene's names."""
    return {variable: text for (owner, variable), text in system.texts.items() if owner == name}


def start_values(system: System, name: str) -> dict[str, float]:
    """Start values of a component of an initialised system (SI, by the scene's names), integers as such.

    Its settings, and what its connected inputs hold at the start.
    """
    component = system.components[name]
    starts: dict[str, float] = {
        variable: value if component.variable(variable).kind is FmiType.REAL else int(value)
        for (owner, variable), value in system.settings.items()
        if owner == name
    }
    fed = [c.input for c in system.connections if c.target == name]
    return starts | dict(zip(fed, component.read(fed), strict=True))


def packed_fmus(scene: Scene, system: System, native: bool, targets: Sequence[str] = ()) -> dict[str, Path]:
    """By component of an initialised system, the FMU for a package.

    Those of the project's own start from `start_values`, and with `native` all of them are native, for
    `targets`, not only those that are in the scene. FMUs given as files are packed unchanged; tools
    that set nothing start them from their own values. Raises TouchdownError where one cannot be made.
    """
    paths: dict[str, Path] = {}
    for name, component in system.components.items():
        assert isinstance(component, ArchivedFmu)
        version = component.description.fmiVersion
        if version != "2.0":
            raise TouchdownError(f"component {name} is FMI {version}; SSP 1.0 packages hold FMI 2.0 only")
        spec = scene.components[name]
        source = locate_fmu(spec.fmu, scene.folder)
        if isinstance(source, Recipe):
            starts = {component.own_name(v): value for v, value in start_values(system, name).items()}
            started = source.starting_from(starts)
            paths[name] = built(started, native or spec.native, targets=targets)
        else:
            paths[name] = component.path
    return paths


def fixed(scene: Scene, system: System) -> list[str]:
    """Components whose values are not in an FMU, since their FMUs are given as files."""
    return [
        name
        for name, spec in scene.components.items()
        if not isinstance(locate_fmu(spec.fmu, scene.folder), Recipe)
        and (start_values(system, name) or texts(system, name))
    ]


def changes(scene: Scene, system: System) -> list[str]:
    """The settings of the user beside the scene, for people, with units."""
    return scene.changes(lambda component, key: system.components[component].variable(key).unit)
