"""Sequences in which the components of a system take a macro step, one module each."""

from __future__ import annotations

from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
from touchdown.master.coupling.steppers.halving import Halving
from touchdown.master.coupling.steppers.iterated import Iterated
from touchdown.master.coupling.steppers.jacobi import Jacobi
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec

SEQUENCES: dict[str, type[Stepper]] = {
    "gauss-seidel": GaussSeidel,
    "jacobi": Jacobi,
    "iterated": Iterated,
    "halving": Halving,
}


def stepper(system: System, run: RunSpec) -> Stepper:
    """What steps `system` by the scheme of `run`."""
    return SEQUENCES[run.scheme.sequence](system, run)
