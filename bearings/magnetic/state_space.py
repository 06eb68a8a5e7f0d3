"""Controller of one or two magnetic bearings by a linear law from a file (`law_file`), in its own samples.

    u_n = hold + C x_n + D m_n        x_(n+1) = A x_n + B m_n

`hold` holds the static load. It is added, and the state begins at zero: so a law without an integrator
holds the load at the centre, too, and one with an integrator, which has no single equilibrium, need not be
solved for one. Between the speeds of a file matrices are interpolated, beyond them the nearest hold, but
not at the start for a rotor that turns the other way, which changes the sign of what couples the axes. A
law of forces is divided by the bearing's k_i.

A law of one axis goes for each, one of a bearing's two for each bearing. There is no anti-windup but that
of the law itself. `levitation` says when it acts. Where the bearing takes no samples, or does so more often
than the law, this samples by its own clock, at the ends of macro steps.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from ...modelkit.errors import require
from ...modelkit.kernel import interpret, kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.status import BAD_INPUT
from ...modelkit.variables import Choices, array, as_tuple, choice, group, groups, integer, real
from . import law, levitation
from .law_file import AXES, SPEEDS, STATES, Law

METHODS = Choices("Discretisation", ("tustin", "matched"), ("", "poles and zeros at exp(s T)"))
OF_CONTINUOUS = ("sample_time", "method", "exact_at")  # what a law in continuous time needs beside its file
SAME = 1e-6  # of a sample time; what differs by less is the same
PROBLEMS = (
    "its law has a sample_time of {0:g} s, and the magnetic bearing one of {1:g} s; set both the same, or "
    "the law's a multiple",
    "its law is for speeds from {0:g} to {1:g} rad/s, and the rotor's is {2:g} rad/s; give the file speeds "
    "of both signs",
)


@dataclass(frozen=True)
class Parameters(levitation.Parameters):
    """What is beside the law."""

    sample_time: float = real(1e-4, "s", "from sample to sample of a law in continuous time", above=0.0)
    method: int = choice(0, METHODS, "how it is made one from sample to sample")
    exact_at: float = real(
        0.0, "rad/s", "where C(z) equals C(s); 0: at rest, if that can be", minimum=0.0, shown="rad/s"
    )


@dataclass(frozen=True)
class _Axis(law.AxisMeasurement):
    """What a bearing tells of an axis."""

    current_factor: float = real(1.0, "N/A", "k_i", above=0.0, constant=True)


@dataclass(frozen=True)
class Inputs(levitation.Inputs):
    """Of the actuators, and of the rotor."""

    axis: tuple = groups(_Axis, AXES)
    speed: float = real(0.0, "rad/s", "of the rotor, counter-clockwise", nominal=1000.0)


@dataclass(frozen=True)
class _Command(law.Command):
    """Command of a controller to an axis, as current and as force."""

    force_set: float = real(0.0, "N", "the same as a force: set times k_i")


@dataclass(frozen=True)
class _OfLaw:
    """What is to be known of a law."""

    deviation: float = real(0.0, "1", "largest |C(z) - C(s)| over |C(s)|", constant=True, local=True)
    at: float = real(0.0, "rad/s", "where, up to a fifth of the sampling's", constant=True, local=True)
    unstable: int = integer(0, "it is, by itself", constant=True, local=True)


@dataclass(frozen=True)
class Outputs(levitation.Outputs):
    """Commands, the state of the controller, and what is to be known of its law."""

    axis: tuple = groups(_Command, AXES)
    law: _OfLaw = group(_OfLaw)


@dataclass(frozen=True)
class _Derived:
    """The law from sample to sample; its unused parts are 0."""

    states: int = integer(0, "in use")
    outputs: int = integer(1, "in use")
    inputs: int = integer(1, "in use")
    speeds: int = integer(1, "in use")
    sample_time: float = real(0.0, "s", "from sample to sample")
    force: int = integer(0, "it gives forces")
    law: _OfLaw = group(_OfLaw)
    speed: np.ndarray = array(SPEEDS)
    A: np.ndarray = array(SPEEDS, STATES, STATES)
    B: np.ndarray = array(SPEEDS, STATES, 2 * AXES)
    C: np.ndarray = array(SPEEDS, AXES, STATES)
    D: np.ndarray = array(SPEEDS, AXES, 2 * AXES)


@dataclass(frozen=True)
class Hidden(levitation.Hidden):
    """Memory from sample to sample, and room for one."""

    begun: np.ndarray = array(AXES)  # m, where the law began
    told: np.ndarray = array(2 * AXES)  # m, what one copy of the law is told
    state: np.ndarray = array(AXES, STATES)  # of each copy
    ahead: np.ndarray = array(STATES)


MEMORY = memory_layout(Parameters, Inputs, Outputs, 1, _Derived, Hidden)


@kernel
def _begin(m):
    """As `levitation` has it."""
    m.s.state[:] = 0.0
    for k in range(AXES):
        m.s.begun[k] = m.u.axis[k].sensed


@kernel
def _between(m):
    """Which of the speeds is below the rotor's, the next one, and how far it is on the way there."""
    speeds, k = m.d.speeds, 0
    if speeds == 1:
        return 0, 0, 0.0
    while k < speeds - 2 and m.u.speed > m.d.speed[k + 1]:
        k += 1
    share = (m.u.speed - m.d.speed[k]) / (m.d.speed[k + 1] - m.d.speed[k])
    return k, k + 1, min(max(share, 0.0), 1.0)


@kernel
def _times(matrices, row, between, x, n):
    """The product of a row with the first n of x; between: which matrices, and how far between them."""
    k, after, share = between
    v = 0.0
    for j in range(n):
        v += ((1.0 - share) * matrices[k, row, j] + share * matrices[after, row, j]) * x[j]
    return v


@kernel
def _answer(lead, period, m):
    """As `levitation` has it."""
    d, s, n, between = m.d, m.s, m.d.outputs, _between(m)
    for copy in range(AXES // n):
        first, x = copy * n, s.state[copy]
        for i in range(n):
            begun, sensed = s.begun[first + i], m.u.axis[first + i].sensed
            s.told[i] = lead * begun - sensed
            if d.inputs > n:
                s.told[i], s.told[n + i] = begun - sensed, (lead - 1.0) * begun
        for row in range(n):
            axis = m.u.axis[first + row]
            v = _times(d.C, row, between, x, d.states) + _times(d.D, row, between, s.told, d.inputs)
            s.asked[first + row] = axis.hold + (v / axis.current_factor if d.force == 1 else v)
        for row in range(d.states):
            v = _times(d.A, row, between, x, d.states) + _times(d.B, row, between, s.told, d.inputs)
            s.ahead[row] = v
        for row in range(d.states):
            x[row] = s.ahead[row]


@kernel
def _turns_the_other_way(speeds, k, speed):
    """Whether a rotor does, by its speed, than at all the first k, several, of `speeds` (rad/s)."""
    return k > 1 and (speed < 0.0 <= speeds[0] or speeds[k - 1] <= 0.0 < speed)


@kernel
def derive(words):
    """See that samples and direction of spin are those of its law, where they are known yet."""
    m = words.view(MEMORY)[0]
    m.n = 1
    m.weight[0] = 0.0
    d, ours, theirs, said = m.d, m.d.sample_time, m.u.period, m.message_numbers
    said[0], said[1] = ours, theirs
    if theirs > 0.0 and (ours < 0.5 * theirs or abs(ours - round(ours / theirs) * theirs) > SAME * theirs):
        return 1
    said[0], said[1], said[2] = d.speed[0], d.speed[d.speeds - 1], m.u.speed
    return 2 if _turns_the_other_way(d.speed, d.speeds, m.u.speed) else 0


@kernel
def _report(m):
    """Put the set points into the outputs as forces, too."""
    for k in range(AXES):
        m.o.axis[k].force_set = m.o.axis[k].set * m.u.axis[k].current_factor


@kernel
def _by_own_clock(m):
    """Whether the bearing's samples are not the law's."""
    return abs(m.d.sample_time - m.u.period) > SAME * m.d.sample_time


@kernel
def start(words):
    """Levitated, with what holds the static load."""
    m = words.view(MEMORY)[0]
    levitation.start(_begin, _by_own_clock(m), m.d.sample_time, m)
    m.o.law.deviation, m.o.law.at, m.o.law.unstable = m.d.law.deviation, m.d.law.at, m.d.law.unstable
    _report(m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    if not math.isfinite(m.u.speed):
        return BAD_INPUT
    status = levitation.advance(_begin, _answer, _by_own_clock(m), m.d.sample_time, m, time, step)
    _report(m)
    return status


@lru_cache(maxsize=16)
def _tables(law: Law, period: float, method: int, exact_at: float) -> np.ndarray:
    """m.d (1,) of a law, made one from sample to sample where it is in continuous time."""
    sampled = law.sampled(period, method, exact_at)
    known = _OfLaw(*((0.0, 0.0) if law.sample_time else law.deviation(sampled)), int(not law.stable))
    speeds, n = sampled.A.shape[:2]
    outputs, inputs = sampled.D.shape[1:]
    whole = _Derived(n, outputs, inputs, speeds, sampled.sample_time, int(law.force), known)
    for name in ("speed", *"ABCD"):
        part: np.ndarray = law.speeds if name == "speed" else getattr(sampled, name)
        getattr(whole, name)[tuple(map(slice, part.shape))] = part
    return np.array([as_tuple(whole)], MEMORY["d"])


def _tabulate(law: Law, p: Any) -> np.ndarray:
    return _tables(law, p.sample_time, p.method, p.exact_at)


def _of_samples(name: str) -> str | None:
    """Names that a law from sample to sample has."""
    return None if name in OF_CONTINUOUS else name


_GENERAL = Model(
    name="amb_state_space",
    title="Controller of magnetic bearings, by a file",
    about="",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    derived=_Derived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=PROBLEMS,
    tabulated=OF_CONTINUOUS,
    starts_from={
        f"axis[{k + 1}].{name}": (f"axis[{k + 1}].hold", *factor)
        for k in range(AXES)
        for name, factor in (("set", ()), ("force_set", (f"axis[{k + 1}].current_factor",)))
    },
)


def law_of_axes(d: Any, speed: float, axes: Sequence[int]) -> Iterator[np.ndarray]:
    """A, B, C, D from -position (m) to set point (A or N) of `axes` (from 0) at a speed (rad/s).

    d: the model's constants, m.d. Raises TouchdownError of a speed that `derive` refuses.
    """
    k, n, width = int(d["speeds"]), int(d["states"]), int(d["outputs"])
    speeds = d["speed"][:k]
    other = interpret(_turns_the_other_way, speeds, k, speed)
    require(not other, f"a controller by a file: {PROBLEMS[1].format(speeds[0], speeds[-1], speed)}")
    shares = [np.interp(speed, speeds, one) for one in np.eye(k)]
    copies = sorted({axis // width for axis in axes})
    used = [copies.index(axis // width) * width + axis % width for axis in axes]
    for name, rows, columns in (("A", n, n), ("B", n, width), ("C", width, n), ("D", width, width)):
        one = np.tensordot(shares, d[name][:k, :rows, :columns], 1)
        whole = np.asarray(block_diag(*[one] * len(copies)))
        whole = whole[used] if name in "CD" else whole
        yield whole[:, used] if name in "BD" else whole


def controller(law: Law, name: str, content: str = "") -> Model:
    """The controller by a law, called `name`; `content` tells those of one name apart."""
    model = replace(
        _GENERAL,
        name=name,
        content=content,
        about=f"State space of {law.title}, with re-levitation",
        tables=partial(_tabulate, law),
    )
    return replace(model, rename=_of_samples, tabulated=()) if law.sample_time else model
