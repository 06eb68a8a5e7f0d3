"""A component as the master sees it: its variables, and calls in a fixed order.

    set(...)  enter()  [push() / pull()]...  exit()  then for each macro step  push()  step(t, H)  pull()

`bind` fixes, before `enter`, which variables are exchanged at every step. A wrong order is a programming
error; mistakes of a user raise TouchdownError.

The names and units of the contract's variables at a port are those of `touchdown.modelkit.ports`. A port
has the motion of a body, which crosses to the bearing, and the load on it, which comes back.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from ...modelkit import ports
from ...modelkit.model import Model, slots
from ...modelkit.variables import Causality, Spec, Variability
from ..common.errors import TouchdownError, one_of
from ..common.units import Unit, to_si


def _declared(*kinds: type) -> dict[str, str]:
    """Names and units of the scalars of declarations, in their order."""
    specs: dict[str, Any] = {f.name: f.metadata.get("spec") for kind in kinds for f in fields(kind)}
    return {name: spec.unit for name, spec in specs.items() if isinstance(spec, Spec)}


def _beyond(kind: type, base: type) -> tuple[str, ...]:
    """The part of a declaration that another one lacks."""
    return tuple(name for name in _declared(kind) if name not in _declared(base))


_LOAD = tuple(_declared(ports.SeatLoad))

STATIC = tuple(_declared(ports.StaticLoad))  # what holds a body at rest
MOTION = tuple(_declared(ports.SeatMotion, ports.MountMotion, ports.StaticLoad))
SENSED = tuple(_declared(ports.PointMotion))
SLOPE = tuple(name for name in _LOAD if name[0] == "d" and name[1:] in _LOAD)
LOAD = tuple(name for name in _LOAD if name not in SLOPE)
SEAT = (*_beyond(ports.SeatMotion, ports.MountMotion), *_beyond(ports.SeatLoad, ports.MountLoad))
MOUNT = _beyond(ports.MountMotion, ports.SeatMotion)  # of a body on springs
MODE_MOTION = tuple(_declared(ports.ModeMotion))  # of an elastic mode, below mode[k] of a port
SLOPE_OF_MODE = "slope"  # 1/m, which a mode's port may lack
MODE_LOAD = tuple(_declared(ports.ModeLoad))
WORK, JUMP = _declared(ports.EnergyAccount)  # what each side states of the energy that crossed
UNITS = _declared(ports.SeatMotion, ports.MountMotion, ports.StaticLoad, ports.SeatLoad)

REPORTS = (  # groups of what bearings and bodies say of themselves, for figures and pictures
    *("contact", "ring", "balls", "inner", "outer", "neighbours", "pockets", "hardest", "cage"),
    *("second_cage", "speed", "energy", "stress", "axis", "limits", "heat", "gaps", "shoulder", "along"),
    "braking",
)
LOOP = (  # what actuators and controllers say of themselves beside those
    *("link", "link_energy", "peak_current", "least_gap", "capacitor", "locked"),
    *("commanded_time", "captured_time", "samples", "missed", "limited_time"),
    *("failed_time", "back_time", "locked_time", "given_x", "given_y"),
)
STROKE = ("stroke", "stop_force")  # what a mount says of itself, alone or for each seat of a foundation
SUPPLIED = "supplied"  # J, energy that a component brings in

MOUNTED = "housing"  # a bearing's port on what it is mounted in
REACH = "contact.reach"  # s, of a touchdown bearing: time until its journal touches, going straight on

POSITION = ("x", "y")
STIFFNESS = "k_over_m"  # 1/s2, of the springs that hold a body
# by which a bearing moves its copy of a body
GAINS = (
    *("inv_m", "inv_I", STIFFNESS, "c_over_m", "inv_m_z", "k_over_m_z", "c_over_m_z"),
    *("inv_I_t", "inv_mI", "gyro"),
)
FORCE = ("fx", "fy")
THRUST = "fz"  # along the shaft
TILT = ("rx", "ry")  # of the shaft, where both sides of a port have it
MOMENTS = ("mx", "my")  # that tilt it
SPATIAL = (  # a port that stays in the plane, or whose shaft keeps its direction, lacks these
    (*_declared(ports.AxialMotion), "k_over_m_z", "c_over_m_z", THRUST, f"d{THRUST}"),
    (*_declared(ports.TiltMotion), *MOMENTS, *(f"d{name}" for name in MOMENTS)),
)
NEEDED = POSITION + FORCE  # no port works without them


class PortDirection(NamedTuple):
    """A way in which a port moves: the names of its motion there, and of the load that moves it."""

    place: str
    rate: str
    acceleration: str
    load: str


ACROSS = tuple(PortDirection(axis, f"v{axis}", f"a{axis}_free", f"f{axis}") for axis in POSITION)
DIRECTIONS = (  # the last ones, along the shaft and of its tilt, only where both sides of a port have them
    *ACROSS,
    PortDirection("z", "vz", "az_free", THRUST),
    *(PortDirection(f"r{axis}", f"w{axis}", f"alpha_{axis}_free", f"m{axis}") for axis in POSITION),
)


def reported(variable: str) -> bool:
    """Whether a variable is an account at a port, or of those that figures and pictures read."""
    group, last = variable.partition(".")[0].partition("[")[0], variable.rpartition(".")[2]
    return group in REPORTS or variable in (SUPPLIED, *LOOP) or last in (WORK, JUMP, *STROKE)


class FmiType(StrEnum):
    """Types of FMI 2.0's variables, and what FMI 3.0 has beside them; its sizes of numbers are left out."""

    REAL = "Real"
    INTEGER = "Integer"
    BOOLEAN = "Boolean"
    STRING = "String"
    ENUMERATION = "Enumeration"
    BINARY = "Binary"
    CLOCK = "Clock"


REPORTED = (Causality.OUTPUT, Causality.LOCAL)  # what is recorded
WHOLE = (FmiType.INTEGER, FmiType.ENUMERATION)  # FMI 2.0 has one function for both
NUMBERS = (FmiType.REAL, *WHOLE)
READABLE = (*NUMBERS, FmiType.BOOLEAN)  # as numbers; a Boolean is 0 or 1
MAX_EXACT_INTEGER = 2**53  # whole numbers up to it are exchanged exactly
SETTABLE = (FmiType.REAL, FmiType.INTEGER, FmiType.BOOLEAN, FmiType.ENUMERATION)  # that by its number
Setting = float | str  # of a number, in SI, or of a String


class Call(StrEnum):
    """The call of a component in a macro step, as messages name it."""

    SET = "setting inputs"
    STEP = "stepping"
    GET = "reading outputs"
    FETCH = "reading values"


@dataclass(frozen=True)
class InMemory:
    """A component that is stepped by one function, its values words of its memory. Arrays stay in place."""

    advance: int  # address of `Model.advance`, as numba compiled it; it answers 0 where it can go on
    words: np.ndarray  # float64, the memory
    work: np.ndarray  # float64 (rows, columns), scratch
    taken: np.ndarray  # int64, which words the exchanged inputs are
    given: np.ndarray  # and the exchanged outputs


@dataclass(frozen=True)
class ByFunctions:
    """A component that has FMI 2.0's C functions, by their addresses. Arrays stay in place."""

    component: int  # address
    set_real: int
    do_step: int
    get_real: int
    get_integer: int
    get_boolean: int
    taken: np.ndarray  # uint32, value references of the exchanged inputs
    given: np.ndarray  # and of the exchanged outputs
    checked: bool  # whether it is to be seen that these are finite numbers
    any_thread: bool  # whether it may be stepped by any thread, beside other components


@dataclass(frozen=True)
class ScalarVariable:
    """One scalar variable of a component."""

    name: str
    reference: int
    kind: FmiType
    causality: Causality
    variability: Variability
    unit: str | None
    minimum: float | None
    maximum: float | None
    start: float | None
    description: str
    element: int = 0  # of an array of FMI 3.0, counted from 0 in the order of its values
    choices: Mapping[str, int] = field(default_factory=dict[str, int])  # an enumeration's, by their words
    relative: bool = False  # whether it is a difference, to which offsets of units do not apply
    structural: bool = False  # whether it is a size of FMI 3.0's arrays, which keeps its start value
    starts: bool = False  # whether it starts from a value that can be set: initial is exact or approx

    @property
    def settable(self) -> bool:
        """Whether a scene may give it a value, before initialisation."""
        starts = self.causality in (Causality.PARAMETER, Causality.INPUT) or self.starts
        return starts and not self.structural and self.kind in (*SETTABLE, FmiType.STRING)

    @property
    def constant(self) -> bool:
        """Whether its value stays constant after initialisation."""
        return self.variability in (Variability.FIXED, Variability.CONSTANT, Variability.TUNABLE)

    def in_words(self, value: float) -> str:
        """A value as people read it: the word for it, if there is one."""
        words = [word for word, number in self.choices.items() if number == value]
        return words[0] if words else f"{value:.6g}"


class Component(ABC):
    """An FMU, or a model stepped in process."""

    def __init__(self, name: str, origin: str, variables: Mapping[str, ScalarVariable]) -> None:
        self.name = name
        self.origin = origin  # the FMU or model, as messages name it
        self.variables = variables
        self.units: Mapping[str, Unit] = {}  # those it defines, by name
        self.model: Model | None = None  # of one of the project's own
        self.third_party = False  # unlike one of the project's own, of any version
        self._own: Mapping[str, str] = {}  # names of variables that go by another name here
        self._fetchers: dict[tuple[str, ...], tuple[Callable[[], np.ndarray], list[int]]] = {}  # of `read`
        self.inputs = np.zeros(0)
        self.outputs = np.zeros(0)

    def variable(self, name: str) -> ScalarVariable:
        """The variable called `name`."""
        try:
            return self.variables[name]
        except KeyError:
            raise TouchdownError(
                f"component {self.name} ({self.origin}) has no variable {name}; "
                + one_of(name, self.variables)
            ) from None

    def rename(self, names: Mapping[str, str]) -> None:
        """Let variables go by other names: `names` gives the component's own for each, or for a whole port.

        Raises TouchdownError where it has no such variable, or one that goes by the new name already.
        """
        names = {
            new: variable_name
            for name, variable_name in names.items()
            for new, variable_name in self._spelled_out(name, variable_name)
        }
        owners = {self.variable(variable_name).name: name for name, variable_name in names.items()}
        for variable_name, name in owners.items():
            if name in self.variables and name not in owners:
                raise TouchdownError(
                    f"component {self.name} ({self.origin}) has a variable {name} of its own; "
                    f"{variable_name} cannot go by that name"
                )
        renamed = {owners.get(name, name): variable for name, variable in self.variables.items()}
        self.variables = {name: replace(variable, name=name) for name, variable in renamed.items()}
        self._own = dict(names)
        self._fetchers.clear()

    def _spelled_out(self, name: str, target: str) -> list[tuple[str, str]]:
        """A name for each variable of the port `own`, or for the variable of that name."""
        inside = [v for v in self.variables if v.startswith(f"{target}.")]
        if target in self.variables or not inside:
            return [(name, target)]
        return [(name + variable.removeprefix(target), variable) for variable in inside]

    def own_name(self, name: str) -> str:
        """The component's own name of the variable `name`."""
        return self._own.get(name, name)

    def second(self) -> Component:
        """Another instance of the same, with the same names, not initialised.

        Raises TouchdownError where there can be none.
        """
        raise TouchdownError(f"there can be no second instance of {self.origin}")

    @abstractmethod
    def set(self, values: Mapping[str, Setting]) -> None:
        """Set what can be set before initialisation; numbers are in SI units and within bounds."""

    @abstractmethod
    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        """Exchange `inputs` through self.inputs, and read variables `names` into `outputs`.

        They are Real, whole or Boolean, and all numbers here; values that a type cannot hold are refused by
        TouchdownError when they come.
        """

    @abstractmethod
    def enter(self, start_time: float, stop_time: float | None = None) -> None:
        """Enter initialisation; `stop_time` (s): no step ends after it; None: that is not known."""

    @abstractmethod
    def exit(self) -> None:
        """Leave initialisation; the component may be stepped."""

    @abstractmethod
    def push(self) -> None:
        """Hand self.inputs over."""

    @abstractmethod
    def pull(self) -> None:
        """Fetch self.outputs."""

    @abstractmethod
    def step(self, time: float, step: float) -> None:
        """Advance from `time` by `step` (s)."""

    def by_address(self) -> InMemory | ByFunctions | None:
        """How compiled code takes the steps of this component, with its present binding; None: it cannot.

        It replaces push, step and pull: a class that overrides one of them overrides this, too.
        """
        return None

    def refuse(self, call: Call, status: int, time: float, step: float) -> None:
        """Raise TouchdownError: compiled code got `status` from `call`, its step from `time` by `step` (s).

        Says what the method for the same call would have said.
        """
        raise NotImplementedError(f"{self.origin} is not stepped by address")

    @abstractmethod
    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        """A function that fetches the values of any variables, for many calls; its array is its own."""

    def read(self, names: Sequence[str]) -> list[float]:
        """Values of any variables, integers and Booleans as whole numbers."""
        asked = tuple(names)
        if asked not in self._fetchers:  # for as long as the component lives: monitors ask at every poll
            whole = [i for i, name in enumerate(asked) if self.variable(name).kind is not FmiType.REAL]
            self._fetchers[asked] = self.reader(asked), whole
        fetch, whole = self._fetchers[asked]
        values = fetch().tolist()
        for i in whole:
            values[i] = int(values[i])
        return values

    foreign = False  # whether it is a third-party FMU
    any_step = True  # whether it takes steps of any length
    inner_step: float | None = None  # s, by which it always steps inside, where it says so
    made_for_step: float | None = None  # s, the macro step that it proposes
    stop_time: float | None = None  # s, when it proposes that a run ends
    can_save = True  # whether its state can be saved

    @abstractmethod
    def save(self) -> object:
        """The whole state, for `restore`; to be given to `release` when it is not needed any more."""

    @abstractmethod
    def restore(self, state: object) -> None:
        """Go back to a saved state."""

    def release(self, state: object) -> None:  # noqa: B027 - most hold nothing outside Python
        """Free a saved state."""

    can_serialise = False  # whether its state can be kept beyond this process

    def to_bytes(self) -> bytes:
        """The whole state, for `from_bytes` of another instance of the same."""
        raise TouchdownError(f"component {self.name} ({self.origin}) cannot give its state as bytes")

    def from_bytes(self, state: bytes, tuned: Mapping[str, Setting]) -> None:
        """Go on from a state, once it is initialised, with tunable parameters that are others than there.

        Raises TouchdownError where it is not a state of the same.
        """
        raise TouchdownError(f"component {self.name} ({self.origin}) cannot take its state as bytes")

    def warned(self) -> str:
        """A line on what an FMU warned of, also once it is closed: how often, and its last words; or ""."""
        return ""

    @abstractmethod
    def close(self) -> str:
        """End and free the component; nothing may be called after it. Returns what went wrong, or ""."""


def value_of(name: str, variable: ScalarVariable, value: object) -> Setting:
    """`value`, a number, or text with a unit or one of the variable's choices, in SI; of a String, text.

    name: COMPONENT.VARIABLE. "on" may be true, and "off" false. Raises TouchdownError where it cannot be
    read.
    """
    if variable.kind is FmiType.STRING:
        if not isinstance(value, str) or "\0" in value:
            raise TouchdownError(f"{name} = {value!r} must be text, without NUL; write it in quotes")
        return value
    if variable.kind is FmiType.BOOLEAN and str(value).casefold() in ("true", "false"):
        return float(str(value).casefold() == "true")
    if not variable.choices:
        return to_si(value, variable.unit, name)
    by_word = {word.casefold(): number for word, number in variable.choices.items()}
    word = str(value).strip().casefold()
    word = word if word in by_word else {"true": "on", "false": "off"}.get(word, word)
    with suppress(TouchdownError):
        number = float(by_word[word]) if word in by_word else to_si(value, variable.unit, name)
        if number in by_word.values():
            return number
    known = ", ".join(f"{word} ({number})" for word, number in variable.choices.items())
    raise TouchdownError(f"{name} = {value!r} is not one of its choices: {known}")


def elements(variables: Iterable[str], array: str) -> list[str]:
    """The elements of an array by their names, in the order in which FMI gives its values."""
    index = re.compile(re.escape(array) + r"\[(\d+(?:, ?\d+)*)\]")
    found = {name: match[1].split(",") for name in variables if (match := index.fullmatch(name))}
    return sorted(found, key=lambda name: list(map(int, found[name])))


def fill_values(
    component: Component, names: Sequence[str], which: np.ndarray, values: np.ndarray, data: np.ndarray
) -> None:
    """Put `values` into `data`, of any type of numbers, or of Booleans.

    values, data: (n,), of the variables `names[i]` for `i` in `which`. Raises TouchdownError where it
    cannot hold one.
    """
    if data.dtype.kind in "iu":
        limits = np.iinfo(data.dtype)
        # float64 holds not the largest integer of 64 bits but the one above it; NaN fails both tests
        held = (values >= float(limits.min)) & (values < float(limits.max) + 1.0)
        if not held.all():
            first = int(np.argmin(held))
            raise TouchdownError(
                f"component {component.name}: {names[int(which[first])]} is given {values[first]:.0f}, and "
                f"holds whole numbers from {limits.min} to {limits.max}"
            )
    data[:] = values


def check_value(component: Component, variable: ScalarVariable, value: float) -> None:
    """Raise TouchdownError where `value` is out of the bounds the component declares."""
    unit = f" {variable.unit}" if variable.unit not in (None, "1") else ""
    what = f"{component.name}.{variable.name} = {value:g}{unit}"
    if variable.kind is not FmiType.REAL and not float(value).is_integer():
        raise TouchdownError(f"{what} must be a whole number")
    known = slots(component.model) if component.model else ()  # of what FMI cannot say: above, not at least
    own = next((slot.variable for slot in known if slot.variable.name == variable.name), None)
    if own and (problem := own.problem(value)):
        raise TouchdownError(f"{component.name}.{problem}")
    if variable.minimum is not None and value < variable.minimum:
        raise TouchdownError(f"{what} must be at least {variable.minimum:g}{unit}")
    if variable.maximum is not None and value > variable.maximum:
        raise TouchdownError(f"{what} must be at most {variable.maximum:g}{unit}")
