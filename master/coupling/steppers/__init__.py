"""Sequences in which the components of a system take a macro step, one module each."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
from touchdown.master.coupling.steppers.halving import Halving
from touchdown.master.coupling.steppers.iterated import Iterated
from touchdown.master.coupling.steppers.jacobi import Jacobi
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec

_sequences: dict[str, type[Stepper]] = {
    "gauss-seidel": GaussSeidel,
    "jacobi": Jacobi,
    "iterated": Iterated,
    "halving": Halving,
}
SEQUENCES: Mapping[str, type[Stepper]] = MappingProxyType(_sequences)
"""All there are, by name: the project's own, then those that were registered."""


def register(name: str, stepper: type[Stepper]) -> None:
    """Let schemes name the sequence `name`. Raises TouchdownError where the name is taken."""
    if name in SEQUENCES:
        raise TouchdownError(f"there is a sequence {name} already; give this one another name")
    _sequences[name] = stepper


def stepper(system: System, run: RunSpec) -> Stepper:
    """What steps `system` by the scheme of `run`."""
    return SEQUENCES[run.scheme.sequence](system, run)
