"""Sequences in which the components of a system take a macro step, one module each."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ....modelkit.ports import HOLD
from ...common.errors import TouchdownError
from ...quantities import declare_quantities, named
from ...scene.run_spec import RunSpec
from ..system import System
from .bonded import Bonded, IteratedBonds
from .gauss_seidel import GaussSeidel
from .halving import Halving
from .iterated import Iterated
from .jacobi import Jacobi
from .stepper import Stepper

_OWN: Mapping[str, type[Stepper]] = {
    "gauss-seidel": GaussSeidel,
    "jacobi": Jacobi,
    "iterated": Iterated,
    "halving": Halving,
}
BONDED: Mapping[type[Stepper], type[Stepper]] = {
    GaussSeidel: Bonded,
    Iterated: IteratedBonds,
}
"""Steppers of systems with and without bonds."""
_sequences: dict[str, type[Stepper]] = dict(_OWN)
SEQUENCES: Mapping[str, type[Stepper]] = MappingProxyType(_sequences)
"""All there are, by name: the project's own, then those that were registered."""


def register_stepper(name: str, stepper: type[Stepper]) -> None:
    """Let schemes name the sequence `name`. Raises TouchdownError as `check_stepper` does."""
    check_stepper(name, stepper)
    declare_quantities(*stepper.quantities)
    _sequences[name] = stepper


def check_stepper(name: str, stepper: object) -> None:
    """Raise TouchdownError where `stepper` is not a Stepper, or its name is another's.

    The class of a notebook's cell that is run again is not the same, but has the same name.
    """
    if not (isinstance(stepper, type) and issubclass(stepper, Stepper)):
        raise TouchdownError(f"sequence {name}: {stepper!r} is not a subclass of Stepper")
    if name in SEQUENCES and _full_name(SEQUENCES[name]) != _full_name(stepper):
        raise TouchdownError(f"there is a sequence {name} already; give this one another name")


def _full_name(kind: type) -> tuple[str, str]:
    return kind.__module__, kind.__qualname__


def registered_steppers() -> dict[str, type[Stepper]]:
    """The steppers that are not the project's own, by name."""
    return {name: kind for name, kind in SEQUENCES.items() if name not in _OWN}


def stepper(system: System, run: RunSpec) -> Stepper:
    """The stepper of `system` by the scheme of `run`. Raises TouchdownError where this process has none."""
    name = run.scheme.sequence
    if name not in SEQUENCES:
        raise TouchdownError(
            f"this process does not know the sequence {name}; put its stepper at the top of a module that "
            "can be imported, and register it from there"
        )
    kind = SEQUENCES[name]
    if not system.bonds:
        return _telling(kind(system, run))
    if kind is Jacobi and run.scheme.order != HOLD:
        raise TouchdownError(
            f"scheme {run.scheme.name} steps all components at once, and {system.bonds[0].title} is a "
            "bond, whose force must be known before it is taken; choose interface, iterated or halving, or "
            "jacobi-hold, which holds its values"
        )
    return _telling(BONDED.get(kind, kind)(system, run))


def _telling(stepper: Stepper) -> Stepper:
    """The stepper. Raises TouchdownError where it tells what no one declared, before the run is over."""
    unknown = [key for key in stepper.figures if not named(key)]
    if unknown:
        raise TouchdownError(
            f"{type(stepper).__name__}.figures has {unknown[0]}, which is not declared; add it to its "
            f'`quantities`, such as touchdown.Quantity.of_scheme("{unknown[0]}", "in words")'
        )
    return stepper
