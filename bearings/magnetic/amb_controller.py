"""Controller of one or two magnetic bearings: a sampled PID per channel, shutdown and re-levitation.

A channel is an axis of a bearing or, for two bearings on one rotor (axes 1 and 2 of the first, 3 and 4 of
the second), the translation or the tilt that both see along one direction: half the sum and half the
difference of their positions. With equal gains both structures are the same.

It uses each sample once, by the bearing's `tick`. What it makes of sample n acts at sample n + 1, and with
`delay` = 1 one later. With its own clock it samples by itself at the ends of macro steps.

States: levitated; waiting, switched off by an `event` until one asks for the rotor again; relevitating: the
controllers begin anew, the integral from what holds the static load, and the reference leads from where the
rotor is to the centre; levitated again once it has stayed within `capture.radius`; failed, with the
amplifiers off, where it has not after `capture.timeout`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.numerics import squared
from ...modelkit.status import BAD_INPUT, OK
from ...modelkit.variables import SWITCH, Choices, choice, group, groups, integer, real
from . import law
from .law import ROUNDING, limited

AXES = 4
EVENTS = 4
NEVER = -1.0  # s
CLOCKS = Choices("Clock", ("tick", "own"), ("the bearing's samples", "its own, at ends of macro steps"))
STRUCTURES = Choices(
    "Structure",
    ("decentralised", "translation_tilt"),
    ("each axis by itself", "translation and tilt of two bearings: channels 1 and 2, 3 and 4"),
)
LEVITATED, RELEVITATING, WAITING, FAILED = range(4)  # states
KINDS = Choices(
    "ControllerEvent",
    ("none", "off", "on"),
    ("nothing", "it is switched off", "the rotor is to be levitated"),
)
OFF, ON = 1, 2


@dataclass(frozen=True)
class _CaptureRule:
    """When the rotor counts as levitated again."""

    radius: float = real(0.15e-3, "m", "within which the rotor must stay", above=0.0)
    time: float = real(0.05, "s", "for which it must stay there", minimum=0.0)
    timeout: float = real(0.5, "s", "after which it is given up", above=0.0)


@dataclass(frozen=True)
class _ControllerEvent:
    """An event that the controller is told of; it acts on the first sample from then on."""

    time: float = real(0.0, "s", "when", minimum=0.0, needs="kind", tunable=True)
    kind: int = choice(0, KINDS, "what", tunable=True)


@dataclass(frozen=True)
class Parameters:
    """For the 1.65 kg of a disk on 26 N/A and -79 kN/m."""

    structure: int = choice(0, STRUCTURES, "what a channel is")
    gain: law.Gain = group(law.Gain)
    channel: tuple = groups(law.Channel, AXES)
    limit: float = real(4.0, "A", "of each set point", above=0.0)
    ramp: float = real(0.02, "s", "in which a levitated rotor is led to the centre again", minimum=0.0)
    clock: int = choice(0, CLOCKS, "whose samples are used")
    sample_time: float = real(
        1e-4, "s", "from sample to sample by its own clock", above=0.0, needs="clock == 1"
    )
    delay: int = choice(0, SWITCH, "one more sample of delay")
    event: tuple = groups(_ControllerEvent, EVENTS)
    capture: _CaptureRule = group(_CaptureRule)


@dataclass(frozen=True)
class Inputs:
    """Inputs from the actuators."""

    axis: tuple = groups(law.AxisMeasurement, AXES)
    tick: float = real(0.0, "1", "number of the bearing's sample to come")
    period: float = real(0.0, "s", "from sample to sample; 0: a macro step", constant=True)


@dataclass(frozen=True)
class Outputs:
    """Commands, and the state of the controller."""

    axis: tuple = groups(law.Command, AXES)
    state: int = integer(LEVITATED, "0 levitated, 1 relevitating, 2 waiting, switched off, 3 failed")
    commanded_time: float = real(
        NEVER, "s", "when it was last asked to levitate; below zero: never", local=True
    )
    captured_time: float = real(
        NEVER, "s", "since when the rotor, levitated again, has been within the radius", local=True
    )
    samples: float = real(0.0, "1", "used since the start", local=True)
    missed: float = real(0.0, "1", "samples of the bearing that were not used", local=True)


@dataclass(frozen=True)
class Hidden:
    """Memory from sample to sample."""

    channel: tuple = groups(law.ChannelMemory, AXES)
    next: tuple = groups(law.Command, AXES)  # waits for the next sample
    seen: float = real(0.0, "1", "last tick that was used")
    led: float = real(NEVER, "s", "when the lead to the centre began")
    tried: float = real(NEVER, "s", "since when it has been re-levitating")
    inside: float = real(NEVER, "s", "since when the rotor has been within the radius")
    on: int = integer(1, "the amplifiers are on")


MEMORY = memory_layout(Parameters, Inputs, Outputs, 1, hidden=Hidden)


@kernel
def mixed(a, b, factor, m):
    """Two bearings' values along one direction as those of two channels (factor 1/2), and back (1)."""
    if m.p.structure == 0:
        return a, b
    return factor * (a + b), factor * (a - b)


@kernel
def _begin_channels(m):
    """Begin all channels anew at the measured positions, with what holds the static load."""
    u, z = m.u.axis, m.s.channel
    for k in range(2):
        y1, y2 = mixed(u[k].sensed, u[k + 2].sensed, 0.5, m)
        hold1, hold2 = mixed(u[k].hold, u[k + 2].hold, 0.5, m)
        law.begin_channel(z[k], y1, hold1)
        law.begin_channel(z[k + 2], y2, hold2)


@kernel
def derive(words):
    """The state has one component, which does not move. Returns 0: nothing can be wrong."""
    m = words.view(MEMORY)[0]
    m.n = 1
    m.weight[0] = 0.0
    return 0


@kernel
def start(words):
    """Levitated, with what holds the static load."""
    m = words.view(MEMORY)[0]
    _begin_channels(m)
    for k in range(AXES):
        m.o.axis[k].set = m.s.next[k].set = m.u.axis[k].hold
    m.s.seen = m.u.tick
    if m.p.clock == 1:
        m.s.seen = math.floor(m.time / m.p.sample_time + 1e-9)


@kernel
def _follow(time, m):
    """Let the last event up to `time` (s) change the state: the rotor is to be levitated or not."""
    kind, since = ON, NEVER
    for event in m.p.event:
        if event.kind != 0 and event.time <= time + ROUNDING and event.time >= since:
            kind, since = event.kind, event.time
    if kind == ON and m.o.commanded_time < since:  # asked for since the last sample
        m.o.commanded_time = since
        if m.s.on == 0:
            _begin_channels(m)
            m.s.on, m.s.led, m.s.tried, m.s.inside = 1, time, time, NEVER
            m.o.state, m.o.captured_time = RELEVITATING, NEVER
    if kind == OFF:
        m.s.on = 0
        m.o.state = WAITING


@kernel
def _judge(time, m):
    """Whether the rotor that is levitated again has been captured, is lost, or has left (now: s)."""
    p, u, s, o = m.p.capture, m.u.axis, m.s, m.o
    if s.tried < 0.0 or s.on == 0:
        return
    r = 0.0
    for k in range(0, AXES, 2):
        r = max(r, math.sqrt(squared(u[k].sensed) + squared(u[k + 1].sensed)))
    if r > p.radius:
        s.inside = NEVER
        if o.state == LEVITATED:
            o.state, o.captured_time, s.tried = RELEVITATING, NEVER, time
    elif s.inside < 0.0:
        s.inside = time
    if o.state == RELEVITATING:
        if s.inside >= 0.0 and time - s.inside >= p.time - ROUNDING:
            o.state, o.captured_time = LEVITATED, s.inside
        elif time - s.tried >= p.timeout - ROUNDING:
            o.state, s.on = FAILED, 0


@kernel
def _update(time, period, m):
    """Use one sample, taken at `time` (s), `period` (s) after the last one."""
    p, u, s, lead = m.p, m.u.axis, m.s, 0.0
    _follow(time, m)
    on = s.on == 1
    if s.led >= 0.0 and p.ramp > 0.0:
        lead = max(1.0 - (time - s.led) / p.ramp, 0.0)
    for k in range(2):
        one, other = s.channel[k], s.channel[k + 2]
        set_points = 0.0, 0.0
        if on:
            one.position, other.position = mixed(u[k].sensed, u[k + 2].sensed, 0.5, m)
            law.update(one, lead * one.begin, period, p.limit, p.gain, p.channel[k])
            law.update(other, lead * other.begin, period, p.limit, p.gain, p.channel[k + 2])
            set_points = mixed(one.output, other.output, 1.0, m)
        for side in range(2):
            o, later = m.o.axis[k + 2 * side], s.next[k + 2 * side]
            now_set, now_on = limited(set_points[side], p.limit), float(s.on)
            if p.delay == 1:
                o.set, later.set, o.enable, later.enable = later.set, now_set, later.enable, now_on
            else:
                o.set, o.enable = now_set, now_on
    _judge(time, m)
    m.o.samples += 1.0


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    u = m.u
    total = u.tick + u.period
    for axis in u.axis:
        total += axis.sensed + axis.hold
    if not math.isfinite(total):
        return BAD_INPUT
    period, tick = m.p.sample_time, u.tick
    if m.p.clock == 1:
        tick = math.floor((time + step) / period + 1e-9)
    elif u.period > 0.0:
        period = u.period
    else:  # a bearing that does not sample counts macro steps, and tells what is at their end
        period = step
    if tick > m.s.seen:
        m.o.missed += tick - m.s.seen - 1.0
        m.s.seen = tick
        sampled = time + step
        if m.p.clock == 1 or u.period > 0.0:
            sampled = (tick if m.p.clock == 1 else tick - 1.0) * period
        _update(sampled, period, m)
    return OK


MODEL = Model(
    name="amb_controller",
    title="Controller of magnetic bearings",
    about="Sampled PID for each axis, or for translation and tilt, with sections and re-levitation",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    starts_from={f"axis[{k + 1}].set": (f"axis[{k + 1}].hold",) for k in range(AXES)},
)
