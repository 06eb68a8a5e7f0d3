"""A foundation that touchdown bearings share: elastic modes, with a carrier on a mount at each seat.

`mount_step` has the equations and how they are stepped. Along the shaft the foundation is rigid, and each
carrier stands on its own spring. Frame and signs as everywhere: x horizontal, y up, SI.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model
from ...modelkit.variables import flatten, groups, integer, real
from . import mount_step
from .mount_law import Carrier, Ground

SEATS, MODES = 4, 8
NAMES = "ABCD"  # of the seats


@dataclass(frozen=True)
class _ShapePoint:
    """Of a mode's shape at a seat."""

    x: float = real(0.0, "1", "horizontally")
    y: float = real(0.0, "1", "vertically")


@dataclass(frozen=True)
class Mode:
    """A mode of the foundation without the carriers."""

    omega: float = real(1000.0, "rad/s", "angular frequency", above=0.0, shown="rad/s")
    damping_ratio: float = real(0.0, "1", "of critical", minimum=0.0)
    mass: float = real(1.0, "kg", "modal mass, to which its shape is scaled", above=0.0)
    shape: tuple = groups(_ShapePoint, SEATS, needs="seats >= #")


@dataclass(frozen=True)
class Parameters(Ground):
    """Two seats, and no mode: each is a mount of its own."""

    seats: int = integer(2, "in use", minimum=1, maximum=SEATS)
    modes: int = integer(0, "in use", minimum=0, maximum=MODES)
    mode: tuple = groups(Mode, MODES, needs="modes >= #")
    mount: tuple = groups(Carrier, SEATS, needs="seats >= #")


Inputs, Outputs, MEMORY = mount_step.declare_model(Parameters, SEATS, MODES)


@kernel
def derive(words):
    """As `mount_step.derive`, of the seats and modes in use."""
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    d.seats, d.modes = p.seats, p.modes
    for i in range(p.modes):
        mode = p.mode[i]
        d.omega[i], d.ratio[i] = mode.omega, mode.damping_ratio
        scale = 1.0 / math.sqrt(mode.mass)
        for j in range(p.seats):
            d.shape[2 * j, i] = scale * mode.shape[j].x
            d.shape[2 * j + 1, i] = scale * mode.shape[j].y
    return mount_step.derive(m)


@kernel
def start(words):
    """At rest, every carrier sagged on its mount, and the modes under all of them."""
    mount_step.start(words.view(MEMORY)[0])


@kernel
def derivative(t, q, dq, words):
    """`mount_step.rhs`, for Python."""
    mount_step.rhs(t, q, dq, words.view(MEMORY)[0])


@kernel
def motion(q, words):
    """`mount_step.publish_seats`, for Python."""
    mount_step.publish_seats(q, words.view(MEMORY)[0])


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s) under the given forces; returns a status."""
    return mount_step.advance(words.view(MEMORY)[0], time, step)


def exposed(name: str) -> str:
    """Seats by letters: seat[1].x is A.x, mount[1].mass mount_A.mass, strokes[1].stroke mount_A.stroke."""
    name = re.sub(r"^(mount|strokes)\[(\d)\]", lambda match: f"mount_{NAMES[int(match[2]) - 1]}", name)
    return re.sub(r"(?:shape|seat)\[(\d)\]", lambda match: NAMES[int(match[1]) - 1], name)


_ALL = tuple(exposed(variable.name) for variable in flatten(Parameters()))
_FIRST = tuple(
    exposed(variable.name)
    for variable in flatten(Outputs())
    if variable.name.startswith(("seat[", "strokes["))
    and not variable.name.endswith((".work", ".jump", ".stop_time", ".stop_hits"))
    and ".heat." not in variable.name
)

MODEL = Model(
    name="foundation",
    title="Foundation",
    about="Elastic modes under several touchdown bearings, with a carrier on a mount at each seat",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    derivative=derivative,
    motion=motion,
    problems=mount_step.PROBLEMS,
    rename=exposed,
    starts_from={name: _ALL for name in (*_FIRST, "energy.potential")},
)
