"""Axial magnetic bearing without its controller: `amb_actuator` along the shaft, with one axis.

Two ring magnets pull at a disc of the rotor, coil 1 towards +z. They have a pole on either side of their
coil, so that K = mu0 N^2 A / 4 of two air gaps, and stand straight to it: F = lambda^2 / (4 K). Tilt of the
disc changes no force. Magnets, amplifiers, DC link, sensor, samples and events are those of `amb_actuator`.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model
from ...modelkit.ports import MountMotion, MountReaction, SeatReaction, SpatialLoad
from ...modelkit.status import OK
from ...modelkit.variables import group, groups, integer
from .. import seat
from ..seat import space
from . import amb_actuator, amplifier, law, sensing
from .amb_actuator import EDDY_LOSS, EVENTS, FLUX, SUPPLIED, AxisState, SetPoints
from .amplifier import AmplifierEvent, PartState
from .injection import INTO_READINGS, injected
from .law import ROUNDING
from .magnet import Circuit, Core
from .sensing import SpatialHeldMotion, Transducer

COILS = 2


@dataclass(frozen=True)
class AxialEvent(AmplifierEvent):
    """The same."""

    coil: int = integer(
        0,
        "which: 1 pulls towards +z, 2 towards -z; of the sensor 1; 0: all",
        minimum=0,
        maximum=COILS,
        needs="kind == 1 or kind == 2 or kind >= 5",
        tunable=True,
    )


@dataclass(frozen=True)
class Parameters(amb_actuator.Parameters):
    """Of a small machine: 28 N/A, -93 kN/m."""

    magnet: Core = group(Core)
    sensing: Transducer = group(Transducer)
    event: tuple = groups(AxialEvent, EVENTS)


@dataclass(frozen=True)
class Inputs(amplifier.Feed):
    """Motion of journal and stator, and the controller's command."""

    journal: SpatialHeldMotion = group(SpatialHeldMotion)
    housing: MountMotion = group(MountMotion)
    axis: tuple = groups(SetPoints, 1)


@dataclass(frozen=True)
class Outputs(amb_actuator.Outputs):
    """As of `amb_actuator`."""

    journal: SeatReaction = group(SeatReaction)
    housing: MountReaction = group(MountReaction)
    axis: tuple = groups(AxisState, 1)


@dataclass(frozen=True)
class Hidden(amb_actuator.Hidden):
    """Memory between steps."""

    seat: space.SpatialSeatMemory = group(space.SpatialSeatMemory)
    axis: tuple = groups(law.Command, 1)
    coil: tuple = groups(PartState, COILS)
    sensor: tuple = groups(PartState, 1)


MEMORY = seat.bearing_memory(Parameters, Outputs, EDDY_LOSS + 1, Circuit, Hidden, Inputs)


@kernel
def displacement(q):
    """Of the journal along the shaft (m), for the one axis."""
    return (q[space.JZ] - q[space.HZ],)


@kernel
def react(t, q, dq, m):
    """`SpatialLoad` of the magnets (N); sets dq of what is inside; t (s) into what is being integrated."""
    t += m.s.done
    u = displacement(q)
    for i in range(FLUX, m.n):  # the state has room for two axes
        dq[i] = 0.0
    force, _ = amb_actuator.drive(m.time + t, u, u, q, dq, m)
    dq[SUPPLIED] = force * (q[space.JVZ] - q[space.HVZ])
    outside = 0.0
    if m.p.inject.force != 0.0 and m.time + m.s.done >= m.p.inject.begin - ROUNDING:
        outside = m.p.inject.force * injected(m.time + t, 0, m.p.inject)
        dq[SUPPLIED] += outside * q[space.JVZ]
    return SpatialLoad(0.0, 0.0, 0.0, 0.0, 0.0, force + outside, 0.0 - force, 0.0, 0.0)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into what is being integrated."""
    space.spatial_copy_rates(m.s.done + t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Largest current and smallest gap, after each accepted micro-step."""
    amb_actuator.watch(t, displacement(q), q, m)


@kernel
def report(q, m):
    """Outputs wanted once per macro step."""
    amb_actuator.report_axes(displacement(q), q, m)


@kernel
def derive(words):
    """As of `amb_actuator`."""
    m = words.view(MEMORY)[0]
    space.set_weights(m.weight)
    return amb_actuator.derive_axes(1.0, m)


@kernel
def start(words):
    """Begin with the currents that hold the static load."""
    m = words.view(MEMORY)[0]
    space.take_spatial_inputs(m.q, m)
    u, force = displacement(m.q), sensing.static_load_along(m.u.journal)
    amb_actuator.begin_axes((force,), u, u, m)
    seat.begin(space.SPATIAL, react, report, m)
    m.n, m.s.seat.modes = m.s.seat.inside, 0  # no elastic mode moves along the shaft
    m.o.journal.fz, m.o.housing.fz = force, 0.0 - force


@kernel
def integrate(m, work, step):
    """Advance m.q by `step` (s). As `seat.integrate`."""
    return amb_actuator.from_tick_to_tick(space.SPATIAL, rhs, observe, m, work, step)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N) under motion and set points m.u, not sampled, at t (s)."""
    m = words.view(MEMORY)[0]
    m.time, m.s.done, m.s.since = t, 0.0, 0.0
    amplifier.let_happen(m.p.event, t, m.s)
    amb_actuator.take_commands(t, m)
    seat.instant(space.SPATIAL, react, 0.0, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    status = amb_actuator.refused(m.u.journal.static_fz, step, m)
    if status != OK:
        return status
    ready = amb_actuator.ready
    return seat.advance(space.SPATIAL, ready, react, integrate, report, words, m, work, time, step)


_HELD = ("journal.az_free", "journal.inv_m_z", "journal.static_fz")
_FACTORS = ("magnet.gap", "magnet.area", "magnet.turns", "amplifier.bias")
_LIMITS = ("amplifier.current_limit", "magnet.flux_limit", "magnet.iron_path")
_SENSED = (
    *("journal.z", "housing.z", "sensing.gain", "sensing.noise", "sensing.seed"),
    *INTO_READINGS,
)

MODEL = Model(
    name="amb_axial",
    title="Axial magnetic bearing without its controller",
    about="Magnets, amplifiers, DC link and sensor of an axial magnetic bearing, for a controller",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    derived=Circuit,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    instant=instant,
    problems=amplifier.PROBLEMS,
    starts_from={
        **dict.fromkeys(("journal.fz", "housing.fz"), _HELD),
        "axis[1].sensed": _SENSED,
        "axis[1].hold": (*_HELD, *_FACTORS, *_LIMITS),
        **dict.fromkeys(("current_factor", "displacement_factor"), _FACTORS),
        "period": ("sample_time",),
    },
)
