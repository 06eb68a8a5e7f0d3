"""Switched amplifiers, one for each coil, as their mean voltage, and the DC link that feeds them.

A current control of the bandwidth w_a at the nominal gap, with or without an integral part, within the
link's voltage U:

    i* = clip(i0 +- i_c, 0, i_max)      v = clip(R i + w_a L0 (i* - i + w_r integral(i* - i)), -U, U)

The integral stands still while v is at a limit. A coil whose amplifier failed is emptied by -U.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.variables import Choices, choice, integer, real

COILS = 4
ALWAYS = -1.0  # s; of a link that was not switched off
KINDS = Choices(
    "SupplyEvent",
    ("none", "coil_off", "coil_on", "link_off", "link_on"),
    (
        "nothing",
        "the amplifier of a coil fails, or of all",
        "the amplifier of a coil works again, or of all",
        "the DC link is cut off, and its voltage falls",
        "the DC link has its voltage again",
    ),
)
NOTHING, COIL_OFF, COIL_ON, LINK_OFF, LINK_ON = range(5)


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
    """The DC link."""

    voltage: float = real(100.0, "V", "of the DC link", minimum=0.0)
    decay: float = real(0.01, "s", "time constant with which it falls once it is cut off", above=0.0)


@dataclass(frozen=True)
class AmplifierEvent:
    """An event of amplifiers or link at an instant."""

    time: float = real(0.0, "s", "when", minimum=0.0, needs="kind", tunable=True)
    kind: int = choice(NOTHING, KINDS, "what", tunable=True)
    coil: int = integer(
        0,
        "which: 1 to 4 for the first axis' +, its -, the second's +, its -; 0: all",
        minimum=0,
        maximum=4,
        needs="kind == 1 or kind == 2",
        tunable=True,
    )


@dataclass(frozen=True)
class CoilState:
    """Whether a coil's amplifier works."""

    alive: float = real(1.0, "1", "0: it failed")


@kernel
def link_voltage(time, off, p):
    """Voltage (V) of the link p (`Supply`) at a time (s); off (s): when it was cut off, `ALWAYS`: not."""
    if off < 0.0:
        return p.voltage
    return p.voltage * math.exp(-(time - off) / p.decay)


@kernel
def set_point(coil, control, p):
    """Set point (A) of a coil by its axis' control current (A), and whether it is cut off above."""
    current = p.bias + control if coil % 2 == 0 else p.bias - control
    return min(max(current, 0.0), p.current_limit), current > p.current_limit


@kernel
def let_happen(events, until, s):
    """Put s.coil and s.link_off as all `events` up to the time `until` (s) leave them.

    The last one counts, whichever its number; of those at the same time, that of the higher number.
    """
    s.link_off, switched = ALWAYS, ALWAYS
    for event in events:
        of_link = event.kind == LINK_OFF or event.kind == LINK_ON
        if of_link and switched <= event.time <= until:
            switched = event.time
            s.link_off = event.time if event.kind == LINK_OFF else ALWAYS
    for k in range(COILS):
        s.coil[k].alive, switched = 1.0, ALWAYS
        for event in events:
            of_coil = event.kind == COIL_OFF or event.kind == COIL_ON
            if of_coil and (event.coil == 0 or event.coil == k + 1) and switched <= event.time <= until:
                switched = event.time
                s.coil[k].alive = 0.0 if event.kind == COIL_OFF else 1.0
