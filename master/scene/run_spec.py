"""How a scene is to be run: [run] of its file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...modelkit.reader import FLAG, Kind, Table, key, kinds, number, whole, word
from ..common.errors import TouchdownError
from .schemes import DEFAULT, SCHEMES, Scheme, scheme
from .tables import BEGINNINGS


def shorter_step(run: RunSpec, share: float, order: int) -> float:
    """A macro step (s) with which the ledger should hold, after `share` of the turnover was too much.

    From the order at which the residual falls with the step, to half of what is warned of.
    """
    factor = 0.5 * run.warn_residual / share if math.isfinite(share) else 0.0
    step = run.macro_step * max(factor, 1e-9) ** (1.0 / order)
    return round_down_125(min(step, 0.5 * run.macro_step))


def round_down_125(step: float) -> float:
    """The largest of 1, 2 or 5 times a power of ten that is not above `step`."""
    power = 10.0 ** math.floor(math.log10(step))
    return power * max(digit for digit in (1, 2, 5) if digit * power <= step * (1.0 + 1e-9))


CALL_TIMEOUT = 60.0  # s
AUTO = "auto"  # as the scheme has it
BONDS = (AUTO, "smooth", "contact", "hold")
END, SETTLED, STANDSTILL, SHUTDOWN = UNTIL = ("end", "settled", "standstill", "shutdown")


def _scheme(value: object, name: str) -> Scheme:
    if not isinstance(value, Scheme):
        return scheme(str(value))
    if SCHEMES.get(value.name) != value:
        raise TouchdownError(f"{name} = {value.name} is not registered; give it to register_scheme first")
    return value


TIME, PART = number("s", above=0.0), number(above=0.0)
STEPS = whole(1, what="whole number of macro steps")


@dataclass(frozen=True)
class RunSpec:
    """How to run."""

    duration: float = key(TIME, 1.0, "from the scene's zero, or from the start where it has none")
    start_time: float = key(
        number("s", minimum=0.0), 0.0, "on the simulation's clock: where all components begin"
    )
    macro_step: float = key(TIME, 2e-5, "from one exchange to the next")
    scheme: Scheme = key(Kind(_scheme, "a scheme"), SCHEMES[DEFAULT], "how the components are coupled")
    tolerance: float = key(
        number("m", above=0.0),
        1e-10,
        "of the interface per macro step, where a scheme repeats or divides it",
    )
    record_every: int = key(STEPS, 5, "from one recorded row to the next")
    record: tuple[str, ...] = key(BEGINNINGS, (), "beginnings of the variables that alone are recorded")
    record_also: tuple[str, ...] = key(
        BEGINNINGS, (), "the same, beside what is recorded anyway: also locals and elements of arrays"
    )
    record_arrays: bool = key(
        FLAG, False, "also elements of long arrays, such as balls; else only at the end"
    )
    warn_residual: float = key(
        PART, 0.02, "share of a connection's turnover at which the ledger warns of its residual"
    )
    stop_residual: float = key(PART, 0.2, "the same, at which it stops the run")
    call_timeout: float = key(TIME, CALL_TIMEOUT, "wall time that a call of an isolated FMU may take")
    time_limit: float = key(
        number("s", minimum=0.0), 0.0, "wall time that stepping may take; 0: as long as it takes"
    )
    bonds: str = key(word(BONDS), AUTO, "how force and motion cross between FMUs that know no contract")
    whirl_halvings: int = key(whole(0, 20), 3, "of the macro step, at most, while a whirl makes energy")
    until: str = key(
        word(UNTIL), END, "or earlier: all seats have settled, rotors stand still, the shutdown comes"
    )
    impact_step: float = key(
        number("s", minimum=0.0), 1e-6, "at most, while two bearings hit a rotor; 0: steps are not divided"
    )


UNITS = {name: kind.unit for name, kind in kinds(RunSpec).items() if kind.unit}  # of those that are numbers


def with_changes(run: RunSpec, changes: Mapping[str, object], where: str = "") -> RunSpec:
    """A copy with the keys of [run] in `changes` set; raises TouchdownError for what cannot be."""
    table, known = Table(f"{where}run.", changes), kinds(RunSpec)
    table.only((*known,))
    values: dict[str, Any] = {name: table.get(name, known[name]) for name in changes}
    return replace(run, **values)
