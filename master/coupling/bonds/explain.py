"""How what is exchanged in a run crosses, in words: nothing runs under a name that it does not deserve."""

from __future__ import annotations

from collections.abc import Iterator

from ...common.text import joined
from ..assembly import ORDER
from ..connections import Connection
from ..steppers.stepper import Stepper
from ..system import System

MAX_NAMED = 4  # single connections that are named


def explain_bonds(stepper: Stepper) -> Iterator[str]:
    """Every seat, bond and single connection with its way, and the order of stepping."""
    system, scheme = stepper.system, stepper.run.scheme
    for a in system.attachments:
        follows_scheme = ORDER in system.components[a.bearing].variables or scheme.sequence == "iterated"
        yield f"{a.title} by {scheme.name if follows_scheme else 'what the bearing itself carries'}"
    crossings = {crossing.bond: crossing for crossing in stepper.crossings}
    for bond in system.bonds:
        found = crossings.get(bond)
        repeated = f" {scheme.name}" if scheme.sequence in ("iterated", "halving") else ""
        way = f"{found.way.name}{repeated}{', force extrapolated' * found.late}" if found else "hold"
        yield f"{bond.title} by {way}"
    singles = [f"{c.source_name} to {c.target_name}" for c in _single(system)]
    if singles:
        yield f"{joined(singles, most=MAX_NAMED)} held"
    if scheme.sequence == "jacobi":
        yield "all components at once"
    else:
        yield f"stepped in the order {', '.join(system.order)}"


def _single(system: System) -> list[Connection]:
    """Connections that are neither of a seat nor of a bond, and carry something at every step."""
    seats = {frozenset((a.bearing, a.body)) for a in system.attachments}
    of_bonds = {c for bond in system.bonds for c in (bond.force, *bond.motion)}
    return [
        c
        for c in system.connections
        if c not in of_bonds and frozenset((c.source, c.target)) not in seats and not system.constant(c)
    ]


def uncoupled_warning(stepper: Stepper) -> str:
    """A warning where the scheme has nothing to act on; else ""."""
    system, name = stepper.system, stepper.run.scheme.name
    held = _single(system)
    if system.attachments or system.bonds or not held:
        return ""
    return (
        f"scheme {name} has nothing to act on: no bearing's port and no bond was found, so {len(held)} "
        f"connections are held over each macro step, in the order {', '.join(system.order)}; where a force "
        "and the motion it acts along are among them, give their units or declare them by bond = [...]"
    )
