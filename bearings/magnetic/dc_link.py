"""The DC link of magnetic bearings: a capacitor that lives on when the mains fail.

The mains keep its voltage from falling below `mains`; they do not take energy back, so that amplifiers and
the rotor's motor may charge it further, up to the `ceiling` of a brake chopper, which burns the rest.
Without mains the voltage follows from the energy E = C U^2/2. Once it falls below `least` the link locks
out, until it has the voltage of the mains again: the actuators are given 0 V, and the electronics is off.

What actuators took, and what the rotor was braked by, comes as energy since the start, so that

    mains + generated = taken + standby + burnt + what the capacitor gained

at the end of each macro step, of any length. Within one their power is taken as constant, and the
voltage is handed over at its end, which acts in the next macro step. Charging takes no time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.numerics import squared
from ...modelkit.status import BAD_INPUT, OK
from ...modelkit.variables import Choices, choice, group, groups, integer, real
from .law import ROUNDING

ACTUATORS, EVENTS = 4, 4
NEVER = -1.0  # s
KINDS = Choices("LinkEvent", ("none", "off", "on"), ("nothing", "the mains fail", "the mains are back"))
OFF, ON = 1, 2
PROBLEMS = (
    "least = {0:g} V, mains = {1:g} V and ceiling = {2:g} V; the mains' voltage must be above least, and "
    "not above ceiling",
)


@dataclass(frozen=True)
class _LinkEvent:
    """An event of the mains."""

    time: float = real(0.0, "s", "when", minimum=0.0, needs="kind", tunable=True)
    kind: int = choice(0, KINDS, "what", tunable=True)


@dataclass(frozen=True)
class Parameters:
    """Of a small machine."""

    capacitance: float = real(2e-3, "F", "of the capacitor", above=0.0)
    mains: float = real(100.0, "V", "below which the mains do not let the voltage fall", above=0.0)
    ceiling: float = real(130.0, "V", "beyond which a brake chopper burns what comes", above=0.0)
    least: float = real(40.0, "V", "below which the link locks out", minimum=0.0)
    standby: float = real(10.0, "W", "consumption of the electronics, steady", minimum=0.0)
    efficiency: float = real(0.9, "1", "of the motor with its inverter, both ways", above=0.0, maximum=1.0)
    event: tuple = groups(_LinkEvent, EVENTS)


@dataclass(frozen=True)
class _Taken:
    """Of an actuator."""

    energy: float = real(0.0, "J", "that its coils took since the start")


@dataclass(frozen=True)
class Inputs:
    """Energies since the start."""

    actuator: tuple = groups(_Taken, ACTUATORS)
    braked: float = real(0.0, "J", "work of the motor's brake on the rotor; falling: the motor drives it")


@dataclass(frozen=True)
class _Energies:
    """Of the link, since the start."""

    stored: float = real(0.0, "J", "energy of the capacitor", local=True)
    mains: float = real(0.0, "J", "that the mains gave", local=True)
    generated: float = real(0.0, "J", "that the motor gave as a generator, less what it took", local=True)
    taken: float = real(0.0, "J", "that the actuators took, less what they gave back", local=True)
    standby: float = real(0.0, "J", "that the electronics took", local=True)
    burnt: float = real(0.0, "J", "in the brake chopper", local=True)


@dataclass(frozen=True)
class Outputs:
    """Voltage for the actuators, and the link's account."""

    voltage: float = real(0.0, "V", "for the actuators; 0: locked out")
    capacitor: float = real(0.0, "V", "voltage of the capacitor", local=True)
    locked: int = integer(0, "the link is locked out", local=True)
    failed_time: float = real(NEVER, "s", "when the mains last failed; below zero: never", local=True)
    back_time: float = real(NEVER, "s", "when they were back after that; below zero: never", local=True)
    locked_time: float = real(NEVER, "s", "when the link last locked out; below zero: never", local=True)
    energy: _Energies = group(_Energies)


@dataclass(frozen=True)
class Hidden:
    """What was told at the end of the last macro step."""

    taken: float = real(0.0, "J", "by the actuators")
    braked: float = real(0.0, "J", "of the rotor")


MEMORY = memory_layout(Parameters, Inputs, Outputs, 1, hidden=Hidden)


@kernel
def _energy(voltage, p):
    """Of the capacitor (J) at a voltage (V)."""
    return 0.5 * p.capacitance * squared(voltage)


@kernel
def _taken(u):
    """What all actuators took since the start (J)."""
    energy = 0.0
    for actuator in u.actuator:
        energy += actuator.energy
    return energy


@kernel
def _failed_at(time, p):
    """When (s) the mains failed that are off at `time` (s), `NEVER`: they are on."""
    back, failed = NEVER, NEVER
    for event in p.event:
        if event.kind == ON and event.time <= time + ROUNDING:
            back = max(back, event.time)
    for event in p.event:
        if event.kind == OFF and back < event.time <= time + ROUNDING:
            failed = event.time if failed < 0.0 else min(failed, event.time)
    return failed


@kernel
def _span(time, left, p):
    """How long (s) nothing happens to the mains from `time` (s) on, at most `left` (s)."""
    for event in p.event:
        if event.kind != 0 and event.time > time + ROUNDING:
            left = min(left, event.time - time)
    return left


@kernel
def _book(time, span, gain, m):
    """Let `gain` (J) less standby, evenly over `span` (s) from `time` (s) on, charge the capacitor."""
    e, p, failed = m.o.energy, m.p, _failed_at(time, m.p)
    standby = p.standby * span if m.o.locked == 0 else 0.0
    e.standby += standby
    before, e.stored = e.stored, e.stored + gain - standby
    full, least, most = _energy(p.mains, p), _energy(p.least, p), _energy(p.ceiling, p)
    if failed < 0.0 and e.stored < full:
        e.mains += full - e.stored
        e.stored = full
    if failed >= 0.0:
        m.o.failed_time, m.o.back_time = failed, NEVER
    elif m.o.failed_time >= 0.0 and m.o.back_time < 0.0:
        m.o.back_time = time
    if e.stored > most:
        e.burnt += e.stored - most
        e.stored = most
    if m.o.locked == 0 and e.stored < least:
        m.o.locked, m.o.locked_time = 1, time + span * (before - least) / (before - e.stored)
    elif m.o.locked == 1 and e.stored >= full:
        m.o.locked = 0


@kernel
def _report(m):
    """Put the voltage into the outputs; of a capacitor that a macro step took more of than it had, 0."""
    m.o.capacitor = math.sqrt(2.0 * max(m.o.energy.stored, 0.0) / m.p.capacitance)
    m.o.voltage = m.o.capacitor if m.o.locked == 0 else 0.0


@kernel
def derive(words):
    """The state has one component, which does not move. Sees that the voltages are in order."""
    m = words.view(MEMORY)[0]
    m.n = 1
    m.weight[0] = 0.0
    p, said = m.p, m.message_numbers
    said[0], said[1], said[2] = p.least, p.mains, p.ceiling
    return 0 if p.least < p.mains <= p.ceiling else 1


@kernel
def start(words):
    """Charged by the mains."""
    m = words.view(MEMORY)[0]
    m.o.energy.stored = _energy(m.p.mains, m.p)
    m.s.taken, m.s.braked = _taken(m.u), m.u.braked
    _report(m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    taken, braked = _taken(m.u), m.u.braked
    if not math.isfinite(taken + braked):
        return BAD_INPUT
    took, work_done = taken - m.s.taken, braked - m.s.braked
    made = m.p.efficiency * work_done if work_done > 0.0 else work_done / m.p.efficiency
    m.s.taken, m.s.braked = taken, braked
    m.o.energy.taken += took
    m.o.energy.generated += made
    done = 0.0
    while step - done > ROUNDING:
        span = _span(time + done, step - done, m.p)
        _book(time + done, span, (made - took) * span / step, m)
        done += span
    _report(m)
    return OK


MODEL = Model(
    name="dc_link",
    title="DC link",
    about="Capacitor, mains, brake chopper and lock-out of a DC link that feeds magnetic bearings",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=PROBLEMS,
    starts_from={"voltage": ("mains",)},
)
