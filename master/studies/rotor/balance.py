"""Whether a scene's rotors have an unbalance, which no variable of a flexible one says."""

from __future__ import annotations

from collections.abc import Iterable

from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.rotor.situations import scene_shaft


def balanced(scene: Scene, bodies: Iterable[str]) -> bool:
    """Whether all these components are rotors of elements or matrices, none with an unbalance."""
    try:
        unbalances = [u for body in bodies for u in scene_shaft(scene, body).unbalances]
        return not any(u.moment for u in unbalances)
    except TouchdownError:  # a rotor of another kind
        return False
