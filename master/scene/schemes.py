"""Coupling schemes: how components exchange motion and load over a macro step.

A scheme says how a bearing carries the bodies through the step (`order`, the contract's
interface.order), whether the load's slope crosses beside its mean, whether the elastic modes of a
flexible rotor are carried, and in which sequence the components are stepped (`coupling.steppers`):

- gauss-seidel: a bearing is stepped first, from the bodies' state at t_n; the bodies then take the same
  step under the load it handed over.
- jacobi: all components are stepped at once, the bodies under the load of the step before; with `lead`
  the bearing hands over the load of the step to come.
- iterated: the step is repeated, the bodies' motion prescribed as a parabola through both of its ends,
  until the ends stay.
- halving: the step is taken whole and in two halves, and divided where they differ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ...modelkit.errors import require
from ...modelkit.ports import ACCELERATION, HOLD, MODEL, VELOCITY
from ..common.errors import TouchdownError, one_of


@dataclass(frozen=True)
class Scheme:
    """One way of coupling.

    `order` says how a bearing carries the bodies' motion through a macro step: 0 held, 1 by their
    velocity, 2 by their acceleration, 3 as an interface model that its own load moves. With `slopes`
    the first moment of its load crosses beside the mean; with `modes` it carries a flexible rotor's
    elastic modes; with `lead` it hands over the load of the step to come. `sequence` names the stepper.
    The errors of motion and ledger fall with macro step ** `error_order` (0: a tolerance sets them),
    from which a shorter step is proposed when the ledger stops a run; `angle_limit` is how many radians the
    journal may swing on its contact within a macro step, from which `touchdown compare --of steps` takes
    its step. Comparisons of schemes and of stability fit the last two.

    >>> touchdown.load("rotor1-9000").run.scheme.title
    'bodies carried with their modes, mean and slope'
    """

    name: str
    title: str
    order: int  # how motion is carried: HOLD, VELOCITY, ACCELERATION or MODEL of modelkit.ports
    slopes: bool  # whether dfx, dfy, dmz are exchanged
    modes: bool  # whether the bearings carry the rotor's elastic modes
    error_order: int  # of motion and of the ledger in the macro step; 0: a tolerance sets the error
    angle_limit: (
        float  # rad, of the journal's swing on its contact in a macro step (`studies.comparison.steps`)
    )
    sequence: str = "gauss-seidel"
    lead: bool = False  # whether bearings hand over the load of the step to come


_OWN = (
    Scheme("hold", "motion held, mean load", HOLD, False, False, 1, 0.01),
    Scheme("velocity", "velocity extrapolated, mean load", VELOCITY, False, False, 2, 0.08),
    Scheme("acceleration", "acceleration extrapolated, mean and slope", ACCELERATION, True, False, 3, 0.2),
    Scheme("point-mass", "bodies carried as point masses, mean and slope", MODEL, True, False, 3, 0.3),
    Scheme("interface", "bodies carried with their modes, mean and slope", MODEL, True, True, 3, 1.0),
    Scheme("iterated", "repeated until both sides agree", ACCELERATION, True, False, 3, 0.35, "iterated"),
    Scheme("halving", "interface, steps halved to a tolerance", MODEL, True, True, 0, 3.0, "halving"),
    Scheme("jacobi-hold", "all at once, motion and load held", HOLD, False, False, 1, 0.004, "jacobi"),
    Scheme("jacobi-velocity", "all at once, velocity", VELOCITY, False, False, 1, 0.005, "jacobi"),
    Scheme("jacobi-interface", "all at once, interface", MODEL, True, True, 1, 0.005, "jacobi"),
    Scheme("jacobi-lead", "all at once, bearings lead", MODEL, True, True, 3, 1.0, "jacobi", lead=True),
)

_schemes = {scheme.name: scheme for scheme in _OWN}
SCHEMES: Mapping[str, Scheme] = MappingProxyType(_schemes)
"""All there are, by name: the project's own, then those that were registered."""

DEFAULT = "interface"


def register_scheme(scheme: Scheme) -> None:
    """Let scenes name `scheme`, which may be known already.

    Raises TouchdownError where its name is another's, or a value cannot be.
    """
    require(
        SCHEMES.get(scheme.name, scheme) == scheme,
        f"there is a scheme {scheme.name} already; give this one another name",
    )
    orders = (HOLD, VELOCITY, ACCELERATION, MODEL)
    require(scheme.order in orders, f"scheme {scheme.name}: order = {scheme.order} must be one of {orders}")
    require(
        scheme.angle_limit > 0.0,
        f"scheme {scheme.name}: angle_limit = {scheme.angle_limit} must be above 0",
    )
    _schemes[scheme.name] = scheme


def registered_schemes() -> list[Scheme]:
    """The schemes that are not the project's own."""
    return [scheme for scheme in SCHEMES.values() if scheme not in _OWN]


def scheme(name: str) -> Scheme:
    """The scheme called `name`."""
    try:
        return SCHEMES[name]
    except KeyError:
        raise TouchdownError(f"unknown scheme {name}; {one_of(name, SCHEMES)}") from None
