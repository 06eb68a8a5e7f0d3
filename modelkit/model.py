"""What a model is: its declarations, its kernels, and where its variables lie in memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np

from touchdown.modelkit.variables import Causality, Nothing, Variable, flatten, layout


class ModelError(Exception):
    """A model cannot go on; the message names the variable, the value and the remedy."""


def same_name(name: str) -> str | None:
    """Variables are exposed by the names they are declared with."""
    return name


def no_check(parameters: Any) -> str | None:
    """Bounds of single parameters suffice."""
    return None


def memory_layout(
    parameters: type,
    inputs: type,
    outputs: type,
    state_size: int,
    derived: type = Nothing,
    hidden: type = Nothing,
) -> np.dtype:
    """Everything an instance of a model is, as one record of 8-byte words, the kernels' `m`.

    `parameters`, `inputs`, `outputs`, `derived` and `hidden` are declarations (`modelkit.variables`),
    `state_size` the components that the state needs at most. Derived constants come last: what stands
    before them is all that changes, and saving it is copying its bytes.
    """
    return np.dtype(
        [
            ("time", "f8"),
            ("half", "f8"),
            ("h", "f8"),
            ("n", "i8"),
            ("evaluations", "i8"),
            ("p", layout(parameters)),
            ("u", layout(inputs)),
            ("o", layout(outputs)),
            ("s", layout(hidden)),
            ("q", "f8", (state_size,)),
            ("weight", "f8", (state_size,)),
            ("d", layout(derived)),
        ]
    )


@dataclass(frozen=True, eq=False)
class Model:
    """A component: its declarations and its kernels. A model is equal to itself only.

    Kernels, compiled by `modelkit.kernel`, see one record `m`, of the dtype `memory` (`memory_layout`):

        m.p        parameters                  as declared, m.p.contact.stiffness
        m.u        inputs                      for the whole macro step
        m.o        outputs                     a body's hold at the end of the macro step; a bearing's
                                               loads are means over it, and slopes
        m.s        hidden memory               kept from step to step
        m.q        state                       (N,), of which m.n components are in use
        m.weight   error weights               (N,), one over the size at which a component matters
        m.time     start of the macro step     s
        m.half     half its length             s
        m.h        micro-step to try next      s
        m.evaluations                          of the right-hand side, since the start
        m.d        constants of the parameters, not saved with the rest

    All in SI; x horizontal, y up, z along the shaft; angles, spins and moments counter-clockwise; a load
    is named after the body it acts on. A kernel changes nothing but what it is said to set:

        start(words)                       sets m.q and m.o from m.p and m.u
        advance(words, work, time, step)   one macro step of `step` (s) from `time` (s): m.q, m.o and
                                           whatever else of m; returns one of `modelkit.status`
        rhs(t, q, dq, m)                   bodies: dq (N,), the time derivative of the state q (N,), under
                                           the loads m.u, mean + slope (t - m.half); t (s) counts from
                                           the start of the macro step
        publish(q, m)                      bodies: m.o from the state q
        instant(t, q, dq, m)               bearings: dq of what is inside and, as means in m.o, the load
                                           at this instant under the motion m.u (monolithic solutions)

    q and dq are handed over beside m because integrators try states that are not m.q. `words` is the
    memory and `work` scratch for an integrator (`dopri.scratch`), both float64. What Python calls at
    every step takes plain words and views them as the record itself, m = words.view(MEMORY)[0]: handing
    a record over costs numba several microseconds.

    `Instance` drives it: check the bounds and `check`, `derive` m.d, fill m.weight by `weights`, start,
    advance. The smallest complete example is `bearings.housing`.
    """

    name: str
    title: str
    about: str
    parameters: type
    inputs: type
    outputs: type
    memory: np.dtype
    start: Callable[[Any], None]
    advance: Callable[[Any, Any, float, float], int]
    weights: Callable[[Any], np.ndarray]  # parameters -> error weights, one for each component in use
    derived: type = Nothing
    hidden: type = Nothing
    derive: Callable[[Any], Any] | None = None  # parameters -> derived
    check: Callable[[Any], str | None] = no_check  # parameters -> what is wrong between them
    rhs: Callable[..., Any] | None = None
    publish: Callable[..., Any] | None = None
    instant: Callable[..., Any] | None = None
    content: str = ""  # of a model made from a file: a hash of it
    rename: Callable[[str], str | None] = same_name
    """Name by which a declared variable is exposed; None hides it (a member of a group not in use)."""
    starts_from: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Which parameters and inputs the first value of an output depends on (FMI InitialUnknowns).
    Names or prefixes ending in a dot; an output that is not listed starts at zero whatever is set."""


@dataclass(frozen=True)
class Slot:
    """Where a variable lives in an instance's memory, counted in 8-byte words."""

    variable: Variable
    causality: Causality  # parameter, input or output
    index: int


@cache
def slots(model: Model) -> tuple[Slot, ...]:
    """All exposed variables of `model`: parameters, inputs, outputs, in memory order.

    Listed once for each model: a rotor has more than a thousand.
    """
    exposed: list[Slot] = []
    for part, kind, causality in (
        ("p", model.parameters, Causality.PARAMETER),
        ("u", model.inputs, Causality.INPUT),
        ("o", model.outputs, Causality.OUTPUT),
    ):
        fields: Any = model.memory.fields
        offset = fields[part][1] // 8
        for i, v in enumerate(flatten(kind())):
            name = model.rename(v.name)
            if name is not None:
                exposed.append(Slot(replace(v, name=name), causality, offset + i))
    return tuple(exposed)
