"""Coupling schemes: how components exchange motion and load over a macro step.

A bearing is stepped first, from the bodies' state at t_n; the bodies then take the same step under the
load it handed over (Gauss-Seidel). Schemes differ in how the bearing carries the bodies through the step
(`order`, the contract's interface.order) and in whether the load's slope crosses beside its mean.
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
    order_of_residual: int  # of the macro step, at which the ledger's residual falls


SCHEMES = {
    scheme.name: scheme
    for scheme in (
        Scheme("hold", "motion held, mean load", order=0, slopes=False, order_of_residual=1),
        Scheme("velocity", "velocity extrapolated, mean load", order=1, slopes=False, order_of_residual=2),
        Scheme(
            "acceleration",
            "acceleration extrapolated, mean and slope",
            order=2,
            slopes=True,
            order_of_residual=3,
        ),
        Scheme("interface", "interface model, mean and slope", order=3, slopes=True, order_of_residual=3),
    )
}

DEFAULT = "interface"


def scheme(name: str) -> Scheme:
    """The scheme called `name`."""
    try:
        return SCHEMES[name]
    except KeyError:
        raise TouchdownError(f"unknown scheme {name}; {one_of(name, SCHEMES)}") from None
