"""Magnetic bearing without its controller: magnets, amplifiers, DC link, sensors, and the sampling.

Two axes of two opposite magnets each carry the journal with what a controller asks for, which is another
component. The bearing samples its sensors itself, at the exact ticks t = n `sample_time` also within a
macro step, and lets the set points that it was last given act at the next tick: what a controller makes of
sample n acts from sample n + 1 on, one sample of delay, at every macro step. Without a sample time
the sensors are told at the end of each macro step and set points act at the beginning of the next.

Failures of amplifiers, link and sensors (`event`) act at their exact times. `axis[k].hold` states the
static load as a control current by the same force law: with a coil off, saturated iron or a current at its
limit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import inlined, kernel
from ...modelkit.model import Model
from ...modelkit.numerics import squared
from ...modelkit.ports import Interface, Load, PlanarMountReaction, PlanarSeatReaction
from ...modelkit.status import BAD_INPUT, OK, TOO_LONG_STEP
from ...modelkit.variables import Choices, choice, group, groups, integer, real
from .. import seat
from . import amplifier, law, magnet, sensing
from .amplifier import ALWAYS, AXES, COIL_OFF, COILS, NOTHING, Amplifier, AmplifierEvent, PartState, Supply
from .injection import INTO_READINGS, Injection, injected
from .law import ROUNDING, limited
from .magnet import EDDIES, EDDY_DIRECT, EDDY_FACTORS, EDDY_RATES, Circuit, Magnet
from .sensing import Sensor

FLUX = seat.INSIDE  # flux linkages of the four coils, V s
RESET = FLUX + COILS  # integrals of the current controls, A s
SENSE = RESET + COILS  # the sensors' low-pass, m
SUPPLIED, TAKEN, AT_CURRENT, AT_VOLTAGE = range(SENSE + 2, SENSE + 6)  # J, J, s, s
SIZE = SENSE + 6
EDDY, EDDY_LOSS = SIZE, SIZE + COILS * EDDIES  # linkages of the eddy currents, V s; their heat, J
EVENTS = 8
COMMANDS = Choices("Command", ("current", "force"))
CURRENT_SCALE = 0.1  # A; an error of the current that matters
SIGNAL_SCALE = 1e-4  # m; a displacement in the gap


@dataclass(frozen=True)
class Parameters:
    """Of a small machine: 26 N/A, -79 kN/m."""

    magnet: Magnet = group(Magnet)
    amplifier: Amplifier = group(Amplifier)
    supply: Supply = group(Supply)
    sensing: Sensor = group(Sensor)
    command: int = choice(0, COMMANDS, "which set point acts, that of the current or of the force")
    sample_time: float = real(
        1e-4, "s", "from sample to sample; 0: no sampling, the end of the macro step counts", minimum=0.0
    )
    inject: Injection = group(Injection)
    event: tuple = groups(AmplifierEvent, EVENTS)
    interface: Interface = group(Interface)


@dataclass(frozen=True)
class SetPoints(law.Command):
    """Command of a controller to an axis, in one of two ways."""

    force_set: float = real(0.0, "N", "force at the centre, where forces are commanded; over k_i")


@dataclass(frozen=True)
class Inputs(amplifier.Feed, sensing.SensedInputs):
    """Motion of journal, stator and sensor, and the controller's commands."""

    axis: tuple = groups(SetPoints, 2)


@dataclass(frozen=True)
class AxisState(law.AxisMeasurement):
    """State of an axis, as a controller reads it, and beyond."""

    current_plus: float = real(0.0, "A", "in the + coil", local=True)
    current_minus: float = real(0.0, "A", "in the - coil", local=True)
    voltage_plus: float = real(0.0, "V", "at the + coil", local=True)
    voltage_minus: float = real(0.0, "V", "at the - coil", local=True)
    force: float = real(0.0, "N", "of the axis on the journal", local=True)


@dataclass(frozen=True)
class _LimitTimes:
    """For how long something was at its limit since the start."""

    current_time: float = real(
        0.0,
        "s",
        "time in the current limit: a set point was cut, or a stuck amplifier gave more",
        local=True,
    )
    voltage_time: float = real(
        0.0, "s", "time in the voltage limit: an amplifier of an enabled axis gave all voltage", local=True
    )


@dataclass(frozen=True)
class Outputs(magnet.Factors):
    """Loads; what a controller takes; what limits and supply went through."""

    journal: PlanarSeatReaction = group(PlanarSeatReaction)
    housing: PlanarMountReaction = group(PlanarMountReaction)
    axis: tuple = groups(AxisState, 2)
    tick: float = real(0.0, "1", "number of the sample to come: t / sample_time")
    period: float = real(0.0, "s", "from sample to sample; 0: none are taken", constant=True)
    link: float = real(0.0, "V", "voltage of the DC link", local=True)
    supplied: float = real(
        0.0, "J", "work of the magnets and of `inject.force` since the start", local=True
    )
    link_energy: float = real(0.0, "J", "that the coils took of the DC link since the start")
    eddy_loss: float = real(0.0, "J", "heat of the eddy currents since the start", local=True)
    peak_current: float = real(0.0, "A", "largest of any coil since the start", local=True)
    least_gap: float = real(0.0, "m", "smallest air gap to the magnets since the start", local=True)
    limits: _LimitTimes = group(_LimitTimes)
    injected: float = real(
        0.0, "1", "sum of the injected lines at the last sample, each of size 1", local=True
    )


@dataclass(frozen=True)
class Hidden:
    """Memory between steps."""

    seat: seat.SeatMemory = group(seat.SeatMemory)
    since: float = real(0.0, "s", "from the inputs to the beginning of the present stretch")
    done: float = real(0.0, "s", "of the stretch, ahead of what is being integrated")
    ticks: int = integer(0, "number of the sample to come")
    begun: int = integer(0, "samples have been taken")
    axis: tuple = groups(law.Command, 2)  # that acts now
    coil: tuple = groups(PartState, COILS)
    sensor: tuple = groups(PartState, AXES)
    link_off: float = real(ALWAYS, "s", "when the link was cut off; below zero: it is on")


MEMORY = seat.bearing_memory(Parameters, Outputs, EDDY_LOSS + 1, Circuit, Hidden, Inputs)


@kernel
def displacement(t, q, m):
    """Journal along both axes, and the sensed place (m), t (s) after the inputs."""
    ex, ey, sx, sy = sensing.sensed_places(t, q, m.u, m.p.sensing.at)
    c, s = m.d.cosine, m.d.sine
    return (c * ex + s * ey, c * ey - s * ex), (c * sx + s * sy, c * sy - s * sx)


@inlined
def coil_state(coil, q, gap, volt, m):
    """Of a coil: voltage (V), current (A), rate of its integral (A), current cut off, voltage at its limit.

    gap (m); volt: the link's voltage (V).
    """
    flux, integral = q[FLUX + coil], q[RESET + coil]
    i = magnet.current_of(flux, gap, m.p.magnet, m.d)
    if m.d.eddy > 0.0:
        return _with_eddies(coil, i, q, volt, m)
    axis, p = m.s.axis[coil // 2], m.p.amplifier
    if m.s.coil[coil].fault != NOTHING:
        volt = amplifier.failed_voltage(m.s.coil[coil].fault, flux, volt)
        return volt, i, 0.0, i > p.current_limit, False
    target, cut = 0.0, False
    if axis.enable > 0.5:
        target, cut = amplifier.set_point(coil, axis.set, p)
    v = p.resistance * i + p.bandwidth * m.d.inductance * (target - i + p.reset * integral)
    if -volt <= v <= volt:
        return v, i, target - i, cut, False
    return limited(v, volt), i, 0.0, cut, axis.enable > 0.5


@kernel
def _with_eddies(coil, settled, q, volt, m):
    """As `coil_state`; settled: current (A) without eddy currents.

    A coil whose amplifier is off is emptied as by a set point of 0: its current ends before its flux does.
    """
    p, fault, target, integral, cut = m.p.amplifier, m.s.coil[coil].fault, 0.0, q[RESET + coil], False
    on = fault == NOTHING and m.s.axis[coil // 2].enable > 0.5
    if on:
        target, cut = amplifier.set_point(coil, m.s.axis[coil // 2].set, p)
    if fault != NOTHING:
        integral = 0.0
    gain, direct, held = p.bandwidth * m.d.inductance, m.d.eddy * EDDY_DIRECT, settled
    for k in range(EDDIES):
        held += m.d.eddy * EDDY_FACTORS[k] * (q[FLUX + coil] - q[EDDY + EDDIES * coil + k])
    i = (held + gain * direct * (target + p.reset * integral)) / (1.0 + gain * direct)
    v = p.resistance * i + gain * (target - i + p.reset * integral)
    if fault != NOTHING and fault != COIL_OFF:
        v = amplifier.failed_voltage(fault, q[FLUX + coil], volt)
    elif -volt <= v <= volt:
        return v, i, (target - i if fault == NOTHING else 0.0), cut, False
    v = limited(v, volt)
    i = (held + direct * v) / (1.0 + direct * p.resistance)
    return v, i, 0.0, cut or (i > p.current_limit and not on), on


@kernel
def _eddy_rates(coil, rate, q, dq, m):
    """Set dq of a coil's eddy currents, and add their heat (W); rate: of its flux linkage (V)."""
    heat = EDDY_DIRECT * rate * rate
    for k in range(EDDIES):
        place = EDDY + EDDIES * coil + k
        dq[place] = EDDY_RATES[k] * (q[FLUX + coil] - q[place])
        heat += EDDY_FACTORS[k] * dq[place] * (q[FLUX + coil] - q[place])
    dq[EDDY_LOSS] += m.d.eddy * heat


@kernel
def drive(time, u, seen, q, dq, m):
    """Forces (N) along the axes at a time (s); sets dq of what is inside but for the work.

    u, seen: displacements of the journal and of the sensed place along each axis (m).
    """
    volt = amplifier.link_voltage(time, m)
    f1, f2, power, any_cut, any_full = 0.0, 0.0, 0.0, False, False
    if m.d.eddy > 0.0:
        dq[EDDY_LOSS] = 0.0
    for coil in range(2 * len(u)):
        flux = q[FLUX + coil]
        gap = magnet.gap_of(coil, u, m.p.magnet, m.d)
        v, i, dq[RESET + coil], cut, full = coil_state(coil, q, gap, volt, m)
        any_cut, any_full = any_cut or cut, any_full or full
        rate = v - m.p.amplifier.resistance * i
        dq[FLUX + coil] = 0.0 if flux <= 0.0 and rate < 0.0 else rate  # amplifiers drive one way only
        if m.d.eddy > 0.0:
            _eddy_rates(coil, dq[FLUX + coil], q, dq, m)
        power += v * i
        pull = m.d.pull * squared(max(flux, 0.0))
        pull = pull if coil % 2 == 0 else -pull
        f1, f2 = (f1 + pull, f2) if coil < 2 else (f1, f2 + pull)
    last = SENSE + len(u) - 1
    dq[SENSE] = sensing.rate(seen[0], q[SENSE], m.p.sensing)
    dq[last] = sensing.rate(seen[-1], q[last], m.p.sensing)
    dq[TAKEN] = power
    dq[AT_CURRENT], dq[AT_VOLTAGE] = 1.0 if any_cut else 0.0, 1.0 if any_full else 0.0
    return f1, f2


@kernel
def react(t, q, dq, m):
    """`Load` of the magnets (N); sets dq of what is inside; t (s) into what is being integrated."""
    t += m.s.done
    u, seen = displacement(m.s.since + t, q, m)
    f1, f2 = drive(m.time + t, u, seen, q, dq, m)
    fx, fy = m.d.cosine * f1 - m.d.sine * f2, m.d.sine * f1 + m.d.cosine * f2
    dq[SUPPLIED] = fx * (q[seat.JVX] - q[seat.HVX]) + fy * (q[seat.JVY] - q[seat.HVY])
    if m.p.inject.force == 0.0 or m.time + m.s.done < m.p.inject.begin - ROUNDING:
        return Load(fx, fy, 0.0, -fx, -fy)
    f1 = m.p.inject.force * injected(m.time + t, 0, m.p.inject)
    f2 = m.p.inject.force * injected(m.time + t, 1, m.p.inject)
    outside_x, outside_y = m.d.cosine * f1 - m.d.sine * f2, m.d.sine * f1 + m.d.cosine * f2
    dq[SUPPLIED] += outside_x * q[seat.JVX] + outside_y * q[seat.JVY]
    return Load(fx + outside_x, fy + outside_y, 0.0, -fx, -fy)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into what is being integrated."""
    seat.copy_rates(m.s.done + t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def watch(t, u, q, m):
    """Note the largest current and the smallest gap; u: displacements along each axis (m)."""
    for coil in range(2 * len(u)):
        gap = magnet.gap_of(coil, u, m.p.magnet, m.d)
        i = magnet.current_of(q[FLUX + coil], gap, m.p.magnet, m.d)
        if m.d.eddy > 0.0:
            volt = amplifier.link_voltage(m.time + m.s.done + t, m)
            _, i, _, _, _ = coil_state(coil, q, gap, volt, m)
        m.o.peak_current = max(m.o.peak_current, i)
    across = math.sqrt(u[0] * u[0] + u[-1] * u[-1]) if len(u) > 1 else abs(u[0])
    m.o.least_gap = min(m.o.least_gap, m.p.magnet.gap - across)


@kernel
def observe(t, q, m):
    """Largest current and smallest gap, after each accepted micro-step."""
    u, _ = displacement(m.s.since + m.s.done + t, q, m)
    watch(t, u, q, m)


@kernel
def ready(m, since):
    """Note the clock; since (s): from the inputs to the stretch that begins at m.time."""
    m.s.since, m.s.done = since, 0.0


@kernel
def sample(time, q, m):
    """Put the sensors' readings (m) at `time` (s) into the outputs."""
    inject = m.p.inject
    for k in range(len(m.o.axis)):
        if m.s.sensor[k].fault == NOTHING:
            noise = sensing.deviation(m.s.ticks, k, m.p.sensing)
            m.o.axis[k].sensed = m.p.sensing.gain * q[SENSE + k] + noise
            if inject.sensed != 0.0:
                m.o.axis[k].sensed += inject.sensed * injected(time, k, inject)
        elif m.s.sensor[k].fault == amplifier.SENSOR_LOST:
            m.o.axis[k].sensed = 0.0
    if inject.sensed != 0.0 or inject.set != 0.0 or inject.force != 0.0:
        m.o.injected = injected(time, max(inject.axis - 1, 0), inject)


@kernel
def take_commands(time, m):
    """Let the set points act from `time` (s) on that were last given."""
    for k in range(len(m.o.axis)):
        command = m.u.axis[k]
        m.s.axis[k].set = command.set if m.p.command == 0 else command.force_set / m.d.current_factor
        m.s.axis[k].enable = command.enable
        if m.p.inject.set != 0.0:
            m.s.axis[k].set += m.p.inject.set * injected(time, k, m.p.inject)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, as of `report_axes`."""
    u, _ = displacement(m.s.since + 2.0 * m.half, q, m)
    report_axes(u, q, m)


@kernel
def report_axes(u, q, m):
    """Currents, voltages, forces, and without a sample time what the sensors tell now; u: as in `watch`."""
    volt = amplifier.link_voltage(m.time + 2.0 * m.half, m)
    for coil in range(2 * len(u)):
        gap, o = magnet.gap_of(coil, u, m.p.magnet, m.d), m.o.axis[coil // 2]
        v, i, _, _, _ = coil_state(coil, q, gap, volt, m)
        if coil % 2 == 0:
            o.voltage_plus, o.current_plus = v, i
            o.force = m.d.pull * (squared(q[FLUX + coil]) - squared(q[FLUX + coil + 1]))
        else:
            o.voltage_minus, o.current_minus = v, i
    if m.p.sample_time == 0.0:
        sample(m.time + 2.0 * m.half, q, m)
        m.s.ticks += 1
    m.o.tick = m.s.ticks
    m.o.link, m.o.supplied, m.o.link_energy = volt, q[SUPPLIED], q[TAKEN]
    m.o.limits.current_time, m.o.limits.voltage_time = q[AT_CURRENT], q[AT_VOLTAGE]
    m.o.eddy_loss = q[EDDY_LOSS] if m.d.eddy > 0.0 else 0.0


@kernel
def derive(words):
    """Error weights of the state, and the constants of the magnets; sees that events can be."""
    m = words.view(MEMORY)[0]
    m.d.cosine, m.d.sine = math.cos(m.p.magnet.angle), math.sin(m.p.magnet.angle)
    seat.set_weights(m.weight)
    return derive_axes(math.cos(m.p.magnet.pole_angle), m)


@kernel
def derive_axes(pole, m):
    """`derive` of what is inside; pole: cosine of the poles' angle."""
    magnet.lay_out_circuit(m.d, m.p.magnet, m.p.amplifier.bias, pole)
    m.n = EDDY_LOSS + 1 if m.d.eddy > 0.0 else SIZE
    for coil in range(len(m.s.coil)):
        m.weight[FLUX + coil] = 1.0 / (CURRENT_SCALE * m.d.inductance)
        m.weight[RESET + coil] = m.p.amplifier.reset / CURRENT_SCALE
        for k in range(EDDIES if m.d.eddy > 0.0 else 0):
            m.weight[EDDY + EDDIES * coil + k] = m.weight[FLUX + coil]
    m.weight[SENSE] = m.weight[SENSE + 1] = 1.0 / SIGNAL_SCALE
    return amplifier.event_problem(m)


@kernel
def start(words):
    """Begin with the currents that hold the static load."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    fx, fy = sensing.static_load(m.u.journal)
    u, seen = displacement(0.0, m.q, m)
    begin_axes((m.d.cosine * fx + m.d.sine * fy, m.d.cosine * fy - m.d.sine * fx), u, seen, m)
    seat.begin(seat.PLANAR, react, report, m)
    m.o.journal.fx, m.o.journal.fy = fx, fy
    m.o.housing.fx, m.o.housing.fy = -fx, -fy


@kernel
def begin_axes(forces, u, seen, m):
    """Let the axes hold static forces (N); u, seen: as in `drive`."""
    m.o.current_factor, m.o.displacement_factor = m.d.current_factor, m.d.displacement_factor
    m.o.period, m.o.least_gap = m.p.sample_time, m.p.magnet.gap
    for k in range(len(forces)):
        m.o.axis[k].hold = magnet.holding_current(forces[k], m.p.magnet, m.d, m.p.amplifier)
        m.s.axis[k].set, m.s.axis[k].enable = m.o.axis[k].hold, 1.0
    if m.p.sample_time > 0.0:
        m.s.ticks = math.ceil((m.time - ROUNDING) / m.p.sample_time)
    for coil in range(2 * len(u)):
        target, _ = amplifier.set_point(coil, m.s.axis[coil // 2].set, m.p.amplifier)
        gap = magnet.gap_of(coil, u, m.p.magnet, m.d)
        m.q[FLUX + coil] = magnet.flux_of(target, gap, m.p.magnet, m.d)
        for k in range(EDDIES if m.d.eddy > 0.0 else 0):
            m.q[EDDY + EDDIES * coil + k] = m.q[FLUX + coil]
    for k in range(len(u)):
        m.q[SENSE + k] = seen[k]
    sample(m.time, m.q, m)
    amplifier.let_happen(m.p.event, m.time - ROUNDING, m.s)


@kernel
def _act(time, left, m):
    """Do what is due at `time` (s): a sample, events.

    Returns how long (s) nothing happens from then on, at most `left` (s).
    """
    ts = m.p.sample_time
    if ts > 0.0:
        if abs(m.s.ticks * ts - time) <= ROUNDING:
            if m.s.begun == 1:
                take_commands(time, m)
            sample(time, m.q, m)
            m.s.ticks += 1
            m.s.begun = 1
        left = min(left, m.s.ticks * ts - time)
    if m.p.inject.force != 0.0 and m.p.inject.begin - time > ROUNDING:
        left = min(left, m.p.inject.begin - time)
    for event in m.p.event:
        if event.kind > 0 and abs(event.time - time) <= ROUNDING:
            amplifier.let_happen(m.p.event, time + ROUNDING, m.s)
        elif event.kind > 0 and event.time > time:
            left = min(left, event.time - time)
    return left


@kernel
def integrate(m, work, step):
    """Advance m.q by `step` (s). As `seat.integrate`."""
    return from_tick_to_tick(seat.PLANAR, rhs, observe, m, work, step)


@kernel
def from_tick_to_tick(carried, rhs, observe, m, work, step):
    """`seat.integrate` in spans, from tick to tick and event to event."""
    h, status, evaluations = m.h, OK, 0
    if m.p.sample_time == 0.0:
        take_commands(m.time, m)
    while status == OK and step - m.s.done > ROUNDING:
        span = _act(m.time + m.s.done, step - m.s.done, m)
        m.h = h
        h, status, more = seat.integrate(carried, rhs, observe, m, work, span)
        evaluations += more
        for coil in range(len(m.s.coil)):
            m.q[FLUX + coil] = max(m.q[FLUX + coil], 0.0)
        m.s.done += span
    m.s.done = 0.0
    return h, status, evaluations


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N) under motion and set points m.u, not sampled, at t (s)."""
    m = words.view(MEMORY)[0]
    m.time, m.s.done, m.s.since = t, 0.0, 0.0
    amplifier.let_happen(m.p.event, t, m.s)
    take_commands(t, m)
    seat.instant(seat.PLANAR, react, 0.0, q, dq, m)


@kernel
def refused(total, step, m):
    """Status of a macro step of `step` (s) that cannot be taken, else OK; total: of inputs of the seat."""
    for axis in m.u.axis:
        total += axis.set + axis.force_set + axis.enable
    if not math.isfinite(total + m.u.link_voltage):
        return BAD_INPUT
    return TOO_LONG_STEP if m.p.sample_time > 0.0 and step > m.p.sample_time + ROUNDING else OK


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    status = refused(sensing.sum_of_inputs(m.u), step, m)
    if status != OK:
        return status
    return seat.advance(seat.PLANAR, ready, react, integrate, report, words, m, work, time, step)


_STATIC = ("journal.inv_m", "journal.static_fx", "journal.static_fy")
_FACTORS = ("magnet.gap", "magnet.area", "magnet.turns", "magnet.pole_angle", "amplifier.bias")
_LIMITS = ("amplifier.current_limit", "magnet.flux_limit", "magnet.iron_path")
_HOLD = ("journal.ax_free", "journal.ay_free", *_STATIC, *_FACTORS, *_LIMITS, "magnet.angle")
_SENSED = (
    *("journal.x", "journal.y", "housing.x", "housing.y", "sensor.x", "sensor.y", "magnet.angle"),
    *("sensing.at", "sensing.gain", "sensing.noise", "sensing.seed"),
    *INTO_READINGS,
)

MODEL = Model(
    name="amb_actuator",
    title="Magnetic bearing without its controller",
    about="Magnets, amplifiers, DC link and sensors of a radial magnetic bearing, for a controller",
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
        **{f"journal.f{axis}": (f"journal.a{axis}_free", *_STATIC) for axis in "xy"},
        **{f"housing.f{axis}": (f"journal.a{axis}_free", *_STATIC) for axis in "xy"},
        **dict.fromkeys(("axis[1].sensed", "axis[2].sensed"), _SENSED),
        **dict.fromkeys(("axis[1].hold", "axis[2].hold"), _HOLD),
        **dict.fromkeys(("current_factor", "displacement_factor"), _FACTORS),
        "period": ("sample_time",),
    },
)
