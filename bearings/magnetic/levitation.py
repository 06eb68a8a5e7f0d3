"""When a controller of magnetic bearings acts: its events, its samples, and the levitation after a drop.

It uses each sample once, by the bearing's `tick`. The bearing takes what it makes of sample n at sample
n + 1, and with `delay` = 1 one later. By a clock of its own it samples at the ends of macro steps; where
the bearing takes no samples that acts at once, and with `delay` = 1 at sample n + 1.

States: levitated; waiting, switched off by an `event` until one asks for the rotor again; relevitating: the
law begins anew, from what holds the static load, and the reference leads from where the rotor is to the
centre; levitated again once it has stayed within `capture.radius`; failed, with the amplifiers off, where
it has not after `capture.timeout`.

A law brings two kernels, which are compiled into the functions below:

    begin(m)                  begins anew at the measured positions
    answer(lead, period, m)   set points (A) into m.s.asked for the samples, with `lead` of the way to the
                              centre left, `period` (s) after the last time
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.status import BAD_INPUT, OK
from ...modelkit.variables import SWITCH, Choices, array, choice, group, groups, integer, real
from . import law
from .law import ROUNDING, limited

AXES = 4
EVENTS = 4
NEVER = -1.0  # s
LEVITATED, RELEVITATING, WAITING, FAILED = range(4)  # states
KINDS = Choices(
    "ControllerEvent",
    ("none", "off", "on"),
    ("nothing", "it is switched off", "the rotor is to be levitated"),
)
OFF, ON = 1, 2


@dataclass(frozen=True)
class CaptureRule:
    """When the rotor counts as levitated again."""

    radius: float = real(0.15e-3, "m", "within which the rotor must stay", above=0.0)
    time: float = real(0.05, "s", "for which it must stay there", minimum=0.0)
    timeout: float = real(0.5, "s", "after which it is given up", above=0.0)


@dataclass(frozen=True)
class ControllerEvent:
    """An event that the controller is told of; it acts on the first sample from then on."""

    time: float = real(0.0, "s", "when", minimum=0.0, needs="kind", tunable=True)
    kind: int = choice(0, KINDS, "what", tunable=True)


@dataclass(frozen=True)
class Parameters:
    """Of any law."""

    limit: float = real(4.0, "A", "of each set point", above=0.0)
    ramp: float = real(0.02, "s", "in which a levitated rotor is led to the centre again", minimum=0.0)
    delay: int = choice(0, SWITCH, "one more sample of delay; the only one if the bearing takes none")
    event: tuple = groups(ControllerEvent, EVENTS)
    capture: CaptureRule = group(CaptureRule)


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
    limited_time: float = real(0.0, "s", "time for which `limit` cut a set point", local=True)


@dataclass(frozen=True)
class Hidden:
    """Memory from sample to sample."""

    asked: np.ndarray = array(AXES)  # A, set points before their limits
    next: tuple = groups(law.Command, AXES)  # waits for the next sample
    seen: float = real(0.0, "1", "last tick that was used")
    led: float = real(NEVER, "s", "when the lead to the centre began")
    tried: float = real(NEVER, "s", "since when it has been re-levitating")
    inside: float = real(NEVER, "s", "since when the rotor has been within the radius")
    on: int = integer(1, "the amplifiers are on")


@kernel
def start(begin, own, period, m):
    """Levitated, with what holds the static load; arguments as in `advance`."""
    begin(m)
    for k in range(AXES):
        m.o.axis[k].set = m.s.next[k].set = m.u.axis[k].hold
    m.s.seen = math.floor(m.time / period + 1e-9) if own else m.u.tick


@kernel
def _follow(begin, time, m):
    """Let the last event up to `time` (s) change the state: the rotor is to be levitated or not."""
    kind, since = ON, NEVER
    for event in m.p.event:
        if event.kind != 0 and event.time <= time + ROUNDING and event.time >= since:
            kind, since = event.kind, event.time
    if kind == ON and m.o.commanded_time < since:  # asked for since the last sample
        m.o.commanded_time = since
        if m.s.on == 0:
            begin(m)
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
def _update(begin, answer, time, period, m):
    """Use one sample, taken at `time` (s), `period` (s) after the last one."""
    p, s, lead, is_cut = m.p, m.s, 0.0, False
    _follow(begin, time, m)
    if s.led >= 0.0 and p.ramp > 0.0:
        lead = max(1.0 - (time - s.led) / p.ramp, 0.0)
    if s.on == 1:
        answer(lead, period, m)
    for k in range(AXES):
        o, later = m.o.axis[k], s.next[k]
        is_cut = is_cut or (s.on == 1 and abs(s.asked[k]) > p.limit)
        now_set, now_on = limited(s.asked[k], p.limit) if s.on == 1 else 0.0, float(s.on)
        if p.delay == 1:
            o.set, later.set, o.enable, later.enable = later.set, now_set, later.enable, now_on
        else:
            o.set, o.enable = now_set, now_on
    _judge(time, m)
    m.o.samples += 1.0
    m.o.limited_time += period if is_cut else 0.0


@kernel
def advance(begin, answer, own, period, m, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status.

    own: it samples by its own clock every `period` (s), not by the bearing's ticks.
    """
    u = m.u
    total = u.tick + u.period
    for axis in u.axis:
        total += axis.sensed + axis.hold
    if not math.isfinite(total):
        return BAD_INPUT
    tick = u.tick
    if own:
        tick = math.floor((time + step) / period + 1e-9)
    elif u.period > 0.0:
        period = u.period
    else:  # a bearing that does not sample counts macro steps, and tells what is at their end
        period = step
    if tick > m.s.seen:
        m.o.missed += tick - m.s.seen - 1.0
        m.s.seen = tick
        sampled = time + step
        if own or u.period > 0.0:
            sampled = (tick if own else tick - 1.0) * period
        _update(begin, answer, sampled, period, m)
    return OK
