"""The contract's variables, as `touchdown.modelkit.ports` declares them: their names at a port, and units.

At a port stands the motion of a body, which crosses to the bearing, and the load on it, which comes back.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from touchdown.modelkit import ports
from touchdown.modelkit.variables import Spec


def _declared(*kinds: type) -> dict[str, str]:
    """Names and units of the scalars of declarations, in their order."""
    specs: dict[str, Any] = {f.name: f.metadata.get("spec") for kind in kinds for f in fields(kind)}
    return {name: spec.unit for name, spec in specs.items() if isinstance(spec, Spec)}


def _beyond(kind: type, base: type) -> tuple[str, ...]:
    """What a declaration has that another has not."""
    return tuple(name for name in _declared(kind) if name not in _declared(base))


_LOAD = tuple(_declared(ports.SeatLoad))

STATIC = tuple(_declared(ports.StaticLoad))  # what holds a body at rest
MOTION = tuple(_declared(ports.SeatMotion, ports.MountMotion, ports.StaticLoad))
SENSED = tuple(_declared(ports.PointMotion))
SLOPE = tuple(name for name in _LOAD if name[0] == "d" and name[1:] in _LOAD)
LOAD = tuple(name for name in _LOAD if name not in SLOPE)
SPIN = (*_beyond(ports.SeatMotion, ports.BodyMotion), *_beyond(ports.SeatLoad, ports.MountLoad))
MOUNT = _beyond(ports.MountMotion, ports.BodyMotion)  # of a body on springs
MODE_MOTION = tuple(_declared(ports.ModeMotion))  # of an elastic mode, below mode[k] of a port
MODE_LOAD = tuple(_declared(ports.ModeLoad))
WORK, JUMP = _declared(ports.Account)  # what each side states of the energy that crossed
UNITS = _declared(ports.SeatMotion, ports.MountMotion, ports.StaticLoad, ports.SeatLoad)

REPORTS = (  # groups of what bearings and bodies say of themselves, for figures and pictures
    *("contact", "ring", "balls", "inner", "outer", "neighbours", "pockets", "hardest", "cage", "speed"),
    *("energy", "stress"),
)
SUPPLIED = "supplied"  # J, energy that a component brings in

MOUNTED = "housing"  # a bearing's port on what it is mounted in
REACH = "contact.reach"  # s, of a touchdown bearing: time until its journal touches, going straight on

POSITION = ("x", "y")
GAINS = ("inv_m", "inv_I", "k_over_m", "c_over_m")  # what a bearing carries a body by
FORCE = ("fx", "fy")
NEEDED = POSITION + FORCE  # no port works without them


def reported(variable: str) -> bool:
    """Whether a variable is an account at a port, or of those that figures and pictures read."""
    group, last = variable.partition(".")[0], variable.rpartition(".")[2]
    return group in REPORTS or variable == SUPPLIED or last in (WORK, JUMP)
