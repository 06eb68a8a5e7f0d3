"""The definition of a model: its declarations, its kernels, and where its variables lie in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np

from .errors import TouchdownError
from .variables import Causality, Nothing, Variable, dtype_of, flatten, layout

MAX_PROBLEM_NUMBERS = 4  # numbers that a text of a problem may hold


class ModelError(TouchdownError):
    """A model cannot go on; the message names the variable, the value and the remedy."""


class StepSizeError(ModelError):
    """A macro step cannot be resolved; a smaller one from the state before may be."""


def same_name(name: str) -> str | None:
    """Variables are exposed by the names they are declared with."""
    return name


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
    `state_size` the components that the state needs at most. Derived constants come behind the state: what
    stands before them is all that changes, and saving it is copying its bytes.
    """
    return dtype_of(
        [
            ("time", "f8"),
            ("half", "f8"),
            ("h", "f8"),
            ("n", "i8"),
            ("evaluations", "i8"),
            ("p", layout(parameters)),
            ("u", layout(inputs)),
            ("o", layout(outputs)),
            ("s", layout(hidden, aligned=True)),
            ("q", "f8", (state_size,)),
            ("weight", "f8", (state_size,)),
            ("d", layout(derived)),
            ("message_numbers", "f8", (MAX_PROBLEM_NUMBERS,)),
        ]
    )


def constants(memory: np.dtype, problems: tuple[str, ...] = ()) -> tuple[np.ndarray, tuple[str, ...]]:
    """Where error weights and constants lie in `memory`, and all texts of `Model.problems`.

    problems: a model's own; a text for each constant that may not exist follows them. The first of the
    integers is how many are its own, the others are the words where one thing ends and the next begins
    (`numerics.words`).
    """
    fields: Any = memory.fields
    ends = [("weight", fields["d"][1] // 8), *_ends(fields["d"][0], "", fields["d"][1] // 8)]
    names = [name for name, _ in ends]
    places = [len(problems), fields["weight"][1] // 8, *(end for _, end in ends)]
    lacking = (
        f"it cannot start ({name} is not a finite number); look for a parameter that is out of all "
        "proportion"
        for name in names
    )
    return np.array(places), (*problems, *lacking)


def _ends(record: np.dtype, prefix: str, start: int) -> list[tuple[str, int]]:
    """Dotted name of each scalar or array in `record`, and the word behind it; `start`: its first word."""
    ends: list[tuple[str, int]] = []
    fields: Any = record.fields or {}
    for name, (kind, offset, *_) in fields.items():
        first = start + offset // 8
        if kind.fields is not None:
            ends += _ends(kind, f"{prefix}{name}.", first)
        else:
            ends.append((f"{prefix}{name}", first + kind.itemsize // 8))
    return ends


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
        m.message_numbers  what there is to say of a problem (4,), for its text

    All in SI; x horizontal, y up, z along the shaft, right-handed; angles, spins and moments
    counter-clockwise seen from the +z end; a load is named after the body it acts on. A kernel
    changes nothing but what it is said to set:

        derive(words)                      sets m.d, m.weight and m.n from m.p; returns 0, or the number,
                                           from 1, of what is wrong with the parameters
        start(words)                       sets m.q and m.o from m.p, m.u and m.d
        advance(words, work, time, step)   one macro step of `step` (s) from `time` (s): m.q, m.o and
                                           all else of m that changes; returns one of `modelkit.status`
        derivative(t, q, dq, words)        bodies: dq (N,), the time derivative of the state q (N,), under
                                           the loads m.u, mean + slope (t - m.half); t (s) counts from
                                           the start of the macro step
        motion(q, words)                   bodies: m.o from the state q
        instant(t, q, dq, words)           bearings: dq of what is inside and, as means in m.o, the load
                                           at this instant under the motion m.u

    `advance_without` gives what `advance` does where none of the `effects` acts, and what only these need
    is then not compiled. The last three are for monolithic solutions, which have no macro steps.

    q and dq are handed over beside m because integrators try states that are not m.q. `words` is the
    memory and `work` scratch for an integrator (`dopri.scratch`), both float64. What Python calls takes
    plain words and views them as the record itself, m = words.view(MEMORY)[0]: handing the record of a
    bearing over costs numba 70 microseconds.

    `derive` takes what single bounds (`Variable.problem`) leave open: `problems[number - 1]` is its text,
    a format of m.message_numbers by {0:g} to {3:g}, which C's printf can write, too. It raises
    nothing, so a constant that does not exist is found by looking at the numbers (`constants`,
    `numerics.words.missing`).

    Where constants need what kernels cannot do, such as eigenvalues, `tables` makes a whole m.d, of the
    parameters named in `tabulated` alone; it lies in the memory before `derive` adds the rest.

    `Instance` drives it: check the bounds, tabulate, derive, start, advance. The smallest complete example
    is `bearings.supports.housing`.
    """

    name: str
    title: str
    about: str
    parameters: type
    inputs: type
    outputs: type
    memory: np.dtype
    derive: Callable[[Any], int]
    start: Callable[[Any], None]
    advance: Callable[[Any, Any, float, float], int]
    effects: tuple[str, ...] = ()  # parameters that are 0 where the effect does not act
    advance_without: Callable[[Any, Any, float, float], int] | None = None  # where none of them acts
    derived: type = Nothing
    hidden: type = Nothing
    problems: tuple[str, ...] = ()  # what `derive` may find wrong
    tables: Callable[[Any], np.ndarray] | None = None  # parameters -> m.d (1,), as far as tabulated
    tabulated: tuple[str, ...] = ()  # parameters that `tables` depends on
    derivative: Callable[..., Any] | None = None
    motion: Callable[..., Any] | None = None
    instant: Callable[..., Any] | None = None
    content: str = ""  # of a model made from a file: a hash of it
    rename: Callable[[str], str | None] = same_name
    """Name by which a declared variable is exposed; None hides it (a member of a group not in use)."""
    starts_from: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Which parameters and inputs the first value of an output depends on (FMI InitialUnknowns).
    An output that is not listed starts at zero with all settings."""

    def advance_with(self, acting: Iterable[str]) -> Callable[[Any, Any, float, float], int]:
        """The kernel that takes a macro step where these effects act."""
        return self.advance if any(acting) or self.advance_without is None else self.advance_without


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
