"""The mount of a touchdown bearing: a carrier on springs, dampers, dry friction, rubber, a film and a stop.

It takes the place of `housing` at the same port. The carrier moves across the shaft's axis; between it and
the ground the elements of `mount_law` act in parallel. `x0`, `y0` put its relaxed place off the rotor's
axis (misalignment). It is one seat on rigid ground (`mount_step`). Frame and signs as everywhere:
x horizontal, y up, SI.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model
from ...modelkit.variables import flatten, groups
from . import mount_step
from .mount_law import BRANCHES, Carrier, Ground


@dataclass(frozen=True)
class Parameters(Ground):
    """Of the carrier, what it stands on, and the ground's gravity."""

    mount: tuple = groups(Carrier, 1)


Inputs, Outputs, MEMORY = mount_step.declare_model(Parameters, 1, 0)


@kernel
def derive(words):
    """As `mount_step.derive`, of one seat."""
    m = words.view(MEMORY)[0]
    m.d.seats = 1
    return mount_step.derive(m)


@kernel
def start(words):
    """At rest, sagged under its own weight on springs and stop."""
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
    """One macro step of `step` (s) from `time` (s) under the given force; returns a status."""
    return mount_step.advance(words.view(MEMORY)[0], time, step)


def exposed(name: str) -> str | None:
    """Without the seat's number: mount[1].mass is mass, seat[1].x seat.x, strokes[1].stroke stroke."""
    if name == "modes_heat":
        return None
    return name.removeprefix("mount[1].").removeprefix("strokes[1].").replace("seat[1]", "seat")


_NAMES = [name for variable in flatten(Parameters()) if (name := exposed(variable.name))]


def _named(*starts: str) -> tuple[str, ...]:
    """Parameters whose names start so."""
    return tuple(name for name in _NAMES if name.startswith(starts))


_MASS = ("mass", "outer_ring")
_BORNE = ("stop.gap", "stop.stiffness", "stop.exponent")
_SAG = _named(*_MASS, "gravity", "inclination", "spring.", *_BORNE)
_HANGS = (*_MASS, "gravity", "inclination", "axial.stiffness")
_TANGENT = _named(
    *_MASS, "spring.xx", "spring.yy", "slide[", *(f"branch[{i + 1}].s" for i in range(BRANCHES))
)

MODEL = Model(
    name="mount",
    title="Mount",
    about="Carrier with the outer ring on springs, dry friction, rubber, a squeeze film and a stop",
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
    starts_from={
        "seat.x": ("x0", *_SAG),
        "seat.y": ("y0", *_SAG),
        "seat.inv_m": _MASS,
        "seat.k_over_m": _TANGENT,
        "seat.c_over_m": _named(*_MASS, "damper.xx", "damper.yy", "film."),
        "seat.c_over_m_z": _named(*_MASS, "axial."),
        "energy.potential": ("y0", *_SAG, "axial.stiffness"),
        **dict.fromkeys(("seat.z", "seat.az_free"), _HANGS),
        **dict.fromkeys(("seat.inv_m_z", "seat.k_over_m_z"), (*_MASS, "axial.stiffness")),
        **dict.fromkeys(("seat.ax_free", "seat.ay_free", "stroke", "peak_stroke"), _SAG),
        **dict.fromkeys(("stop_force", "peak_stop_force"), _SAG),
    },
)
