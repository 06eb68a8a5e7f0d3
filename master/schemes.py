"""Coupling schemes: how components exchange motion and load over a macro step.

A bearing is stepped first, from the bodies' state at t_n; the bodies then take the same step under the
load it handed over (Gauss-Seidel). Schemes differ in how the bearing carries the bodies through the step
(`order`, the contract's interface.order), in whether the load's slope crosses beside its mean, and in
whether the elastic modes of a flexible rotor are carried (`interface`) or lumped into a mass.
"""

from __future__ import annotations

from dataclasses import dataclass

from master.errors import TouchdownError, one_of


@dataclass(frozen=True)
class Scheme:
    """One way of coupling."""

    name: str
    title: str
    order: int  # 0 held, 1 velocity, 2 acceleration extrapolated, 3 interface model
    slopes: bool  # whether dfx, dfy, dmz are exchanged
    modes: bool  # whether the bearings carry the rotor's elastic modes
    order_of_residual: int  # of the macro step, at which the ledger's residual falls


SCHEMES = {
    scheme.name: scheme
    for scheme in (
        Scheme("hold", "motion held, mean load", 0, False, False, 1),
        Scheme("velocity", "velocity extrapolated, mean load", 1, False, False, 2),
        Scheme("acceleration", "acceleration extrapolated, mean and slope", 2, True, False, 3),
        Scheme("point-mass", "bodies carried as point masses, mean and slope", 3, True, False, 3),
        Scheme("interface", "bodies carried with their elastic modes, mean and slope", 3, True, True, 3),
    )
}

DEFAULT = "interface"


def scheme(name: str) -> Scheme:
    """The scheme called `name`."""
    try:
        return SCHEMES[name]
    except KeyError:
        raise TouchdownError(f"unknown scheme {name}; {one_of(name, SCHEMES)}") from None
