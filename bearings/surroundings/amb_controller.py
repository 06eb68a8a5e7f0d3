"""Controller of one or two magnetic bearings: a sampled PID per channel, shutdown and re-levitation.

A channel is an axis of a bearing or, for two bearings on one rotor (axes 1 and 2 of the first, 3 and 4 of
the second), the translation or the tilt that both see along one direction: half the sum and half the
difference of their positions. With equal gains both structures are the same.

It uses each sample once, as the bearing's `tick` tells it. What it makes of sample n the bearing lets act
at sample n + 1: one sample of delay, and with `delay` = 1 one more. With its own clock it samples by itself
at the ends of macro steps.

States: levitated; waiting, switched off by an `event` until one asks for the rotor again; relevitating: the
controllers begin anew, the integral from what holds the static load, and the reference leads from where the
rotor is to the centre; levitated again once the rotor has stayed within `capture.radius`; failed, with the
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
from ..magnetic import law

AXES = 4
EVENTS = 4
ROUNDING = 1e-12  # s
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
class Capture:
    """When the rotor counts as levitated again."""

    radius: float = real(0.15e-3, "m", "within which the rotor must stay", above=0.0)
    time: float = real(0.05, "s", "for which it must stay there", minimum=0.0)
    timeout: float = real(0.5, "s", "after which it is given up", above=0.0)


@dataclass(frozen=True)
class Event:
    """An event that the controller is told of; it acts on the first sample from then on."""

    time: float = real(0.0, "s", "when", minimum=0.0, needs="kind")
    kind: int = choice(0, KINDS, "what")


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
    event: tuple = groups(Event, EVENTS)
    capture: Capture = group(Capture)


@dataclass(frozen=True)
class Measured:
    """Measured position of an axis, and its holding current."""

    sensed: float = real(0.0, "m", "position", nominal=1e-4)
    hold: float = real(0.0, "A", "control current that holds the static load", constant=True)


@dataclass(frozen=True)
class Inputs:
    """Inputs from the actuators."""

    axis: tuple = groups(Measured, AXES)
    tick: float = real(0.0, "1", "number of the bearing's sample to come")
    period: float = real(0.0, "s", "from sample to sample; 0: a macro step", constant=True)


@dataclass(frozen=True)
class Command:
    """Command to an axis."""

    set: float = real(0.0, "A", "control current")
    enable: float = real(1.0, "1", "0: the amplifiers are to be off")


@dataclass(frozen=True)
class Outputs:
    """Commands, and the state of the controller."""

    axis: tuple = groups(Command, AXES)
    state: int = integer(LEVITATED, "0 levitated, 1 relevitating, 2 waiting, switched off, 3 failed")
    commanded_time: float = real(
        NEVER, "s", "when it was last asked to levitate; below zero: never", local=True
    )
    captured_time: float = real(
        NEVER,
        "s",
        "since when the rotor has been within the radius, once it is levitated again",
        local=True,
    )
    samples: float = real(0.0, "1", "used since the start", local=True)
    missed: float = real(0.0, "1", "samples of the bearing that were not used", local=True)


@dataclass(frozen=True)
class Next:
    """A set point that waits for the next sample."""

    set: float = real(0.0, "A", "control current")
    enable: float = real(1.0, "1", "0: off")


@dataclass(frozen=True)
class Hidden:
    """Memory from sample to sample."""

    channel: tuple = groups(law.ChannelMemory, AXES)
    next: tuple = groups(Next, AXES)
    seen: float = real(0.0, "1", "last tick that was used")
    led: float = real(NEVER, "s", "when the lead to the centre began")
    tried: float = real(NEVER, "s", "since when it has been re-levitating")
    inside: float = real(NEVER, "s", "since when the rotor has been within the radius")
    on: int = integer(1, "the amplifiers are on")


MEMORY = memory_layout(Parameters, Inputs, Outputs, 1, hidden=Hidden)


@kernel
def spread(a, b, m):
    """Of the values at both bearings along one direction, those of the two channels."""
    if m.p.structure == 0:
        return a, b
    return 0.5 * (a + b), 0.5 * (a - b)


@kernel
def joined(a, b, m):
    """Of the values of two channels, those at both bearings along one direction."""
    if m.p.structure == 0:
        return a, b
    return a + b, a - b


@kernel
def _limited(value, limit):
    """The value, cut off at +-`limit` (both A)."""
    return min(max(value, -limit), limit)


@kernel
def _begin_channels(m):
    """Begin all channels anew at the measured positions, with what holds the static load."""
    u, z = m.u.axis, m.s.channel
    for k in range(2):
        y1, y2 = spread(u[k].sensed, u[k + 2].sensed, m)
        hold1, hold2 = spread(u[k].hold, u[k + 2].hold, m)
        law.begin(z[k], y1, hold1)
        law.begin(z[k + 2], y2, hold2)


@kernel
def derive(words):
    """The state has one component, which does not move. Returns 0: nothing can be wrong."""
    m = words.view(MEMORY)[0]
    m.n = 1
    m.weight[0] = 0.0
    return 0


@kernel
def start(words):
    """Levitated, with what holds the static load; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    _begin_channels(m)
    for k in range(AXES):
        hold = m.u.axis[k].hold
        m.o.axis[k].set, m.o.axis[k].enable = hold, 1.0
        m.s.next[k].set, m.s.next[k].enable = hold, 1.0
    m.s.seen = m.u.tick
    if m.p.clock == 1:
        m.s.seen = math.floor(m.time / m.p.sample_time + 1e-9)
    m.s.led, m.s.tried, m.s.inside, m.s.on = NEVER, NEVER, NEVER, 1
    m.o.state, m.o.commanded_time, m.o.captured_time = LEVITATED, NEVER, NEVER


@kernel
def _levitating(now, m):
    """Whether the rotor is to be levitated at the time `now` (s), and since when (s): by the last event."""
    kind, since = ON, NEVER
    for n in range(EVENTS):
        event = m.p.event[n]
        if event.kind != 0 and event.time <= now + ROUNDING and event.time >= since:
            kind, since = event.kind, event.time
    return kind == ON, since


@kernel
def _follow(now, m):
    """Let what is wanted at the time `now` (s) change the state."""
    want, since = _levitating(now, m)
    if want and m.o.commanded_time < since:  # asked for since the last sample
        m.o.commanded_time = since
        if m.s.on == 0:
            _begin_channels(m)
            m.s.on, m.s.led, m.s.tried, m.s.inside = 1, now, now, NEVER
            m.o.state, m.o.captured_time = RELEVITATING, NEVER
    if not want:
        m.s.on = 0
        m.o.state = WAITING


@kernel
def _judge(now, m):
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
            o.state, o.captured_time, s.tried = RELEVITATING, NEVER, now
    elif s.inside < 0.0:
        s.inside = now
    if o.state == RELEVITATING:
        if s.inside >= 0.0 and now - s.inside >= p.time - ROUNDING:
            o.state, o.captured_time = LEVITATED, s.inside
        elif now - s.tried >= p.timeout - ROUNDING:
            o.state, s.on = FAILED, 0


@kernel
def _control(now, period, m):
    """Outputs of all channels at the time `now` (s), `period` (s) after the last sample."""
    p, u = m.p, m.u.axis
    lead = 0.0
    if m.s.led >= 0.0 and p.ramp > 0.0:
        lead = max(1.0 - (now - m.s.led) / p.ramp, 0.0)
    for k in range(2):
        m.s.channel[k].position, m.s.channel[k + 2].position = spread(u[k].sensed, u[k + 2].sensed, m)
    for k in range(AXES):
        z = m.s.channel[k]
        law.update(z, lead * z.begin, period, p.limit, p.gain, p.channel[k])


@kernel
def _update(now, period, m):
    """Use one sample, taken at the time `now` (s), `period` (s) after the last one."""
    _follow(now, m)
    if m.s.on == 1:
        _control(now, period, m)
    for k in range(2):
        set1, set2 = 0.0, 0.0
        if m.s.on == 1:
            set1, set2 = joined(m.s.channel[k].output, m.s.channel[k + 2].output, m)
        _hand_over(k, _limited(set1, m.p.limit), m)
        _hand_over(k + 2, _limited(set2, m.p.limit), m)
    _judge(now, m)
    m.o.samples += 1.0


@kernel
def _hand_over(k, value, m):
    """Give the set point (A) of axis k, now or with the next sample."""
    o, later = m.o.axis[k], m.s.next[k]
    if m.p.delay == 1:
        o.set, o.enable = later.set, later.enable
        later.set, later.enable = value, float(m.s.on)
    else:
        o.set, o.enable = value, float(m.s.on)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    u = m.u
    total = u.tick + u.period
    for k in range(AXES):
        total += u.axis[k].sensed + u.axis[k].hold
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
        now = time + step
        if m.p.clock == 1 or u.period > 0.0:
            now = (tick if m.p.clock == 1 else tick - 1.0) * period
        _update(now, period, m)
    return OK


_HOLD = tuple(f"axis[{k + 1}].hold" for k in range(AXES))

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
    starts_from={f"axis[{k + 1}].set": (_HOLD[k],) for k in range(AXES)},
)
