"""How a scene is to be run: [run] of its file."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..common.errors import TouchdownError, one_of
from ..common.units import to_si
from .schemes import DEFAULT, SCHEMES, Scheme, scheme
from .tables import above_zero, beginnings, refuse_unknown, step_count, switch


def shorter_step(run: RunSpec, share: float, order: int) -> float:
    """A macro step (s) with which the ledger should hold, after `share` of the turnover was too much.

    From the order at which the residual falls with the step, to half of what is warned of.
    """
    wanted = 0.5 * run.warn_residual / share if math.isfinite(share) else 0.0
    step = run.macro_step * max(wanted, 1e-9) ** (1.0 / order)
    return tidy(min(step, 0.5 * run.macro_step))


def tidy(step: float) -> float:
    """The largest of 1, 2 or 5 times a power of ten that is not above `step`."""
    power = 10.0 ** math.floor(math.log10(step))
    return power * max(digit for digit in (1, 2, 5) if digit * power <= step * (1.0 + 1e-9))


CALL_TIMEOUT = 60.0  # s
AUTO = "auto"  # as the scheme has it
BONDS = (AUTO, "smooth", "contact", "hold")
END, SETTLED = UNTIL = ("end", "settled")
UNITS = {  # of the keys of [run] that are numbers
    **dict.fromkeys(("duration", "start_time", "macro_step", "call_timeout", "impact_step"), "s"),
    "tolerance": "m",
    **dict.fromkeys(("record_every", "warn_residual", "stop_residual", "whirl_halvings"), "1"),
}


@dataclass(frozen=True)
class RunSpec:
    """How to run."""

    duration: float = 1.0  # s, from the scene's zero, or from the start where it has none
    start_time: float = 0.0  # s, on the simulation's clock: where all components begin
    macro_step: float = 2e-5  # s
    scheme: Scheme = SCHEMES[DEFAULT]
    tolerance: float = 1e-10  # m, of the interface per macro step, for schemes that repeat or divide it
    record_every: int = 5  # macro steps
    record: tuple[str, ...] = ()  # beginnings of COMPONENT.VARIABLE that alone are recorded
    record_also: tuple[str, ...] = ()  # the same, beside what is recorded anyway: also locals and elements
    record_arrays: bool = False  # also elements of long arrays, such as balls; else only at the end
    warn_residual: float = 0.02  # ledger's residual over the turnover of a connection: say so
    stop_residual: float = 0.2  # the same: stop
    call_timeout: float = CALL_TIMEOUT  # s of wall time that a call of an isolated FMU may take
    bonds: str = AUTO  # one of BONDS: how force and motion cross between FMUs that know no contract
    whirl_halvings: int = 3  # of the macro step, at most, while a whirl makes energy; 0: none
    until: str = END  # of the duration, or earlier once all seats have settled
    impact_step: float = 1e-6  # s, at most, while two bearings hit a rotor; 0: macro steps are not divided


def with_changes(run: RunSpec, changes: Mapping[str, object]) -> RunSpec:
    """A copy with the keys of [run] in `changes` set; raises TouchdownError for what cannot be."""
    refuse_unknown(changes, tuple(READERS), "[run]")
    values: dict[str, Any] = {key: READERS[key](value, f"run.{key}") for key, value in changes.items()}
    return replace(run, **values)


def _scheme(value: object, name: str) -> Scheme:
    if not isinstance(value, Scheme):
        return scheme(str(value))
    if SCHEMES.get(value.name) != value:
        raise TouchdownError(f"{name} = {value.name} is not registered; give it to register_scheme first")
    return value


def _among(words: Sequence[str]) -> Callable[[object, str], str]:
    def read(value: object, name: str) -> str:
        if value not in words:
            raise TouchdownError(f"{name} = {value}: {one_of(str(value), words)}")
        return str(value)

    return read


def _above_zero(unit: str) -> Callable[[object, str], float]:
    def read(value: object, name: str) -> float:
        return above_zero(value, unit, name)

    return read


def _time(value: object, name: str) -> float:
    seconds = to_si(value, "s", name)
    if seconds < 0.0:
        raise TouchdownError(f"{name} = {value} must not be below 0 s")
    return seconds


def _steps_above_zero(value: object, name: str) -> int:
    above_zero(value, "1", name)
    return step_count(value, name)


def _count(value: object, name: str) -> int:
    number = to_si(value, "1", name)
    if not 0.0 <= number <= 20.0 or number != int(number):
        raise TouchdownError(f"{name} = {value} must be a whole number from 0 to 20")
    return int(number)


READERS: Mapping[str, Callable[[object, str], object]] = {  # of [run], from what stands in a file
    "scheme": _scheme,
    "bonds": _among(BONDS),
    "until": _among(UNTIL),
    "record": beginnings,
    "record_also": beginnings,
    "record_arrays": switch,
    "duration": _above_zero("s"),
    "start_time": _time,
    "macro_step": _above_zero("s"),
    "tolerance": _above_zero("m"),
    "record_every": _steps_above_zero,
    "warn_residual": _above_zero("1"),
    "stop_residual": _above_zero("1"),
    "call_timeout": _above_zero("s"),
    "whirl_halvings": _count,
    "impact_step": _time,
}
