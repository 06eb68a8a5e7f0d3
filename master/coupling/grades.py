"""Balance quality grades, such as "G2.5", as settings of a rotor's unbalance.

ISO 21940-11 permits the unbalance U = m e with e times the spin speed equal to the grade in mm/s. A rigid
rotor has e as its eccentricity; the unbalances of a rotor's file are scaled so that their amounts sum up to
U. Their places and angles stay.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from ...fmus.recipes import mean_eccentricity
from ...modelkit.errors import require
from ..components.component import Component, value_of
from ..scene.scene import ComponentSpec, Scene

GRADE = re.compile(r"\s*G\s*(\d+\.?\d*)\s*")
SCALE = "unbalance_scale"
KEYS = ("eccentricity", SCALE)


def grades(spec: ComponentSpec) -> dict[str, float]:
    """A component's settings that are balance quality grades (mm/s)."""
    settings = {**spec.inherited, **spec.set}
    matches = {key: GRADE.fullmatch(str(settings.get(key))) for key in KEYS}
    return {key: float(match[1]) for key, match in matches.items() if match}


def ungraded(scene: Scene, component: Component) -> ComponentSpec:
    """A component's settings, those that are grades as numbers. Raises TouchdownError for a still rotor."""
    spec = scene.components[component.name]
    settings = {**spec.inherited, **spec.set}
    found = {key: _permitted(scene, component, key, g, settings) for key, g in grades(spec).items()}
    return replace(
        spec,
        set={key: found.get(key, value) for key, value in spec.set.items()},
        inherited={key: found.get(key, value) for key, value in spec.inherited.items()},
    )


def _permitted(
    scene: Scene, component: Component, key: str, grade: float, settings: Mapping[str, object]
) -> float:
    """The eccentricity (m) that a grade (mm/s) permits, or the factor by which a file's have it."""
    place = f"{component.name}.{key} = 'G{grade:g}'"
    speed = component.variables.get("speed")
    spin = value_of(f"{component.name}.speed", speed, settings.get("speed", speed.start)) if speed else 0.0
    require(spin, f"{place} is a balance quality grade, and the rotor stands still; set its speed")
    eccentricity = 1e-3 * grade / abs(float(spin))
    if key != SCALE:
        return eccentricity
    own = mean_eccentricity(scene.components[component.name].fmu, scene.folder)
    require(own, f"{place} scales unbalances, and the rotor's file has none; add [[unbalance]]")
    return eccentricity / own
