"""Sequences in which the components of a system take a macro step, one module each."""

from __future__ import annotations

from master.scene import RunSpec
from master.schemes import scheme
from master.steppers.gauss_seidel import GaussSeidel
from master.steppers.halving import Halving
from master.steppers.iterated import Iterated
from master.steppers.jacobi import Jacobi
from master.steppers.stepper import Stepper
from master.system import System

SEQUENCES: dict[str, type[Stepper]] = {
    "gauss-seidel": GaussSeidel,
    "jacobi": Jacobi,
    "iterated": Iterated,
    "halving": Halving,
}


def stepper(system: System, run: RunSpec) -> Stepper:
    """What steps `system` by the scheme of `run`."""
    return SEQUENCES[scheme(run.scheme).sequence](system, run)
