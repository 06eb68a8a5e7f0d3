"""The FMUs that a package holds: each starts from what its component starts from in the scene.

Not every tool reads a package's values. One that sets nothing then runs the same drop.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from touchdown.fmus.build import build
from touchdown.fmus.python.link import LinkError, interpreter
from touchdown.fmus.recipes import Recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import Component, Kind
from touchdown.master.components.fmu import ArchivedFmu
from touchdown.master.components.library.sources import built, locate
from touchdown.master.coupling.system import System
from touchdown.master.scene.scene import Scene


@dataclass(frozen=True)
class Making:
    """How a package's FMUs of the project's own are made; neither: as the scene has them."""

    link_python: bool = False  # for hosts without Python on this machine
    native: bool = False  # for hosts without Python anywhere

    def __post_init__(self) -> None:
        if self.link_python and self.native:
            raise TouchdownError("an FMU is native or linked to a Python; choose one")


AS_IN_SCENE = Making()


def start_values(system: System, name: str) -> dict[str, float]:
    """What a component of an initialised system starts from (SI, by the scene's names), integers as such.

    Its settings, and what its connected inputs hold at the start.
    """
    component = system.components[name]
    starts: dict[str, float] = {
        variable: value if component.variable(variable).kind is Kind.REAL else int(value)
        for (owner, variable), value in system.settings.items()
        if owner == name
    }
    fed = [c.input for c in system.connections if c.target == name]
    return starts | dict(zip(fed, component.read(fed), strict=True))


def packed_fmus(scene: Scene, system: System, making: Making, folder: Path) -> dict[str, Path]:
    """By component of an initialised system, the FMU for a package; some are built into `folder`.

    Those of the project's own start from `start_values`. FMUs that are given as files stay as they are, and
    tools that set nothing start them from their own. Raises TouchdownError where one cannot be made.
    """
    paths: dict[str, Path] = {}
    for name, component in system.components.items():
        assert isinstance(component, ArchivedFmu)
        if component.description.fmiVersion != "2.0":
            raise TouchdownError(
                f"component {name} is FMI {component.description.fmiVersion}; SSP 1.0 packages and "
                "containers hold FMI 2.0 only"
            )
        spec = scene.components[name]
        source = locate(spec.fmu, scene.folder)
        if isinstance(source, Recipe):
            started = source.starting_from(_by_own_names(component, start_values(system, name)))
            if making.link_python:
                paths[name] = _linked(started, folder / name)
            else:
                paths[name] = built(started, making.native or spec.native)
        else:
            paths[name] = component.path
    return paths


def fixed(scene: Scene, system: System) -> list[str]:
    """Components with values that are in no FMU, since theirs are given as files."""
    return [
        name
        for name, spec in scene.components.items()
        if not isinstance(locate(spec.fmu, scene.folder), Recipe) and start_values(system, name)
    ]


def changes(scene: Scene, system: System) -> list[str]:
    """What the user set beside the scene, for people, with units."""
    return scene.changes(lambda component, key: system.components[component].variable(key).unit)


def _by_own_names(component: Component, values: Mapping[str, float]) -> dict[str, float]:
    return {component.own_name(variable): value for variable, value in values.items()}


def _linked(recipe: Recipe, folder: Path) -> Path:
    try:
        return build(recipe, folder, interpreter())
    except LinkError as error:
        raise TouchdownError(str(error)) from None
