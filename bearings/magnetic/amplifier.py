"""Switched amplifiers, one for each coil, as their mean voltage, and the DC link that feeds them.

A current control of the bandwidth w_a at the nominal gap, with or without an integral part, within the
link's voltage U:

    i* = clip(i0 +- i_c, 0, i_max)      v = clip(R i + w_a L0 (i* - i + w_r integral(i* - i)), -U, U)

The integral stands still while v is at a limit. A coil whose amplifier failed is emptied by -U; a shorted
one has v = 0, and one whose amplifier is stuck v = U. A sensor's signal may be lost or stuck, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import Choices, choice, integer, real

AXES, COILS = 2, 4
ALWAYS = -1.0  # s; of a link that was not switched off
KINDS = Choices(
    "SupplyEvent",
    (
        *("none", "coil_off", "coil_on", "link_off", "link_on"),
        *("coil_short", "coil_stuck", "sensor_lost", "sensor_stuck", "sensor_on"),
    ),
    (
        "nothing",
        "the amplifier of a coil fails, or of all",
        "coil and amplifier work again, or all",
        "the DC link is cut off, and its voltage falls",
        "the DC link has its voltage again",
        "a coil's terminals are shorted, and its amplifier is off",
        "the amplifier of a coil gives all voltage, and obeys no set point",
        "the signal of an axis' sensor is 0 from the next sample on, or of both",
        "the signal of an axis' sensor stays what it was in the last sample, or of both",
        "the sensor of an axis works again, or both",
    ),
)
NOTHING, COIL_OFF, COIL_ON, LINK_OFF, LINK_ON = range(5)
COIL_SHORT, COIL_STUCK, SENSOR_LOST, SENSOR_STUCK, SENSOR_ON = range(5, 10)
LINK, COIL, SENSOR = range(3)
OF = (-1, COIL, COIL, LINK, LINK, COIL, COIL, SENSOR, SENSOR, SENSOR)  # by kind: what it happens to
PROBLEMS = (
    "event[{0:g}].coil = {1:g}: sensors are numbered 1 to {2:g} by axis; 0 is all",
    "event[{0:g}] is of its own link, and another one feeds it; make it an event of that one (off, on)",
)


@dataclass(frozen=True)
class Amplifier:
    """All four alike."""

    bias: float = real(2.0, "A", "bias current i0", above=0.0)
    current_limit: float = real(6.0, "A", "current limit: largest set point of a coil's current", above=0.0)
    resistance: float = real(0.5, "Ohm", "of a coil", minimum=0.0)
    bandwidth: float = real(
        4000.0 * math.pi, "rad/s", "of the current control at the nominal gap", above=0.0, shown="rad/s"
    )
    reset: float = real(
        0.0, "rad/s", "integral corner frequency of the current control, 1/T_i", minimum=0.0, shown="rad/s"
    )


@dataclass(frozen=True)
class Supply:
    """The DC link, where no other one feeds the actuator."""

    voltage: float = real(100.0, "V", "of the DC link", minimum=0.0)
    decay: float = real(0.01, "s", "time constant with which it falls once it is cut off", above=0.0)


@dataclass(frozen=True)
class Feed:
    """The DC link outside."""

    link_voltage: float = real(-1.0, "V", "of the DC link that feeds it; below zero: `supply` is its own")


@dataclass(frozen=True)
class AmplifierEvent:
    """An event of amplifiers, link or sensors at an instant."""

    time: float = real(0.0, "s", "when", minimum=0.0, needs="kind", tunable=True)
    kind: int = choice(NOTHING, KINDS, "what", tunable=True)
    coil: int = integer(
        0,
        "which: 1 to 4 for the first axis' +, its -, the second's +, its -; of sensors 1, 2; 0: all",
        minimum=0,
        maximum=4,
        needs="kind == 1 or kind == 2 or kind >= 5",
        tunable=True,
    )


@dataclass(frozen=True)
class PartState:
    """Whether a coil with its amplifier works, or a sensor."""

    fault: int = integer(NOTHING, "number of the last event, 0: it works")


@inlined
def link_voltage(time, m):
    """Voltage (V) of the link at a time (s); m: an actuator's memory."""
    off, p = m.s.link_off, m.p.supply
    if m.u.link_voltage >= 0.0:
        return m.u.link_voltage
    if off < 0.0:
        return p.voltage
    return p.voltage * math.exp(-(time - off) / p.decay)


@inlined
def set_point(coil, control, p):
    """Set point (A) of a coil by its axis' control current (A), and whether it is cut off above."""
    current = p.bias + control if coil % 2 == 0 else p.bias - control
    return min(max(current, 0.0), p.current_limit), current > p.current_limit


@kernel
def _last(events, until, part, number):
    """The last of the `events` up to the time `until` (s) that happened to a part: its kind, and when (s).

    part: `LINK`, `COIL` or `SENSOR`, which one by its number from 1.
    """
    kind, time = NOTHING, ALWAYS
    for event in events:
        ours = OF[event.kind] == part and (part == LINK or event.coil == 0 or event.coil == number)
        if ours and time <= event.time <= until:
            kind, time = event.kind, event.time
    return kind, time


@kernel
def let_happen(events, until, s):
    """Put s.coil, s.sensor and s.link_off as all `events` up to the time `until` (s) leave them.

    The last one counts, whichever its number; of those at the same time, that of the higher number.
    """
    kind, time = _last(events, until, LINK, 0)
    s.link_off = time if kind == LINK_OFF else ALWAYS
    for k in range(len(s.coil)):
        kind, _ = _last(events, until, COIL, k + 1)
        s.coil[k].fault = NOTHING if kind == COIL_ON else kind
    for k in range(len(s.sensor)):
        kind, _ = _last(events, until, SENSOR, k + 1)
        s.sensor[k].fault = NOTHING if kind == SENSOR_ON else kind


@kernel
def event_problem(m):
    """The number in `PROBLEMS` of the first event that cannot be, or 0; m: an actuator's memory."""
    sensors, numbers = len(m.s.sensor), m.message_numbers
    for k, event in enumerate(m.p.event):
        if OF[event.kind] == SENSOR and event.coil > sensors:
            numbers[0], numbers[1], numbers[2] = k + 1, event.coil, sensors
            return 1
        if OF[event.kind] == LINK and m.u.link_voltage >= 0.0:
            numbers[0] = k + 1
            return 2
    return 0


@kernel
def failed_voltage(fault, flux, volt):
    """Voltage (V) of a coil after such an event, by its flux linkage (V s) and the link's voltage (V)."""
    if fault == COIL_STUCK:
        return volt
    return -volt if fault == COIL_OFF and flux > 0.0 else 0.0
