"""Bonds: a force that one component gives and another takes, and the motion that comes back.

Their product is power, so what crosses a bond can be audited, and exchanged as neither of both can alone.
The force side of the force takes motion; its motion side gives it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ....modelkit.ports import HOLD
from ...common.errors import TouchdownError
from ...common.units import Unit
from ...components.component import Component
from ...scene.run_spec import AUTO, RunSpec
from ...scene.scene import BondSpec, Wire
from ..connections import Attachment, Connection


@dataclass(frozen=True)
class BondHold:
    """How motion is told ahead and force handed on over a macro step.

    `stretches`: parts of the step after each of which the force is known; `ahead` and `force`: points that
    the polynomials of motion and force pass through at most, 0 and 1 for values that are held. Their errors
    fall with macro step ** `error_order`.
    """

    name: str
    title: str
    stretches: int
    ahead: int
    force: int
    error_order: int

    @property
    def held(self) -> bool:
        """Whether plain values are held over the step."""
        return self.ahead == 0


WAYS: Mapping[str, BondHold] = {
    way.name: way
    for way in (
        BondHold("smooth", "motion extrapolated, force after it, each by two holds", 1, 2, 4, 4),
        BondHold("contact", "the same twice a step", 2, 2, 3, 3),
        BondHold("hold", "force and motion held", 1, 0, 1, 1),
    )
}


def hold_of(run: RunSpec) -> BondHold:
    """The one that a run asks for, or that fits its scheme."""
    if run.bonds != AUTO:
        return WAYS[run.bonds]
    if run.scheme.order == HOLD:
        return WAYS["hold"]
    return WAYS["smooth" if run.scheme.sequence == "gauss-seidel" else "contact"]


Dimension = Mapping[str, int]
NEWTON: Dimension = {"kg": 1, "m": 1, "s": -2}
NEWTON_METRE: Dimension = {"kg": 1, "m": 2, "s": -2}
KINDS: tuple[tuple[Dimension, Dimension, Dimension], ...] = (  # force, position, velocity
    (NEWTON, {"m": 1}, {"m": 1, "s": -1}),
    (NEWTON_METRE, {"rad": 1}, {"rad": 1, "s": -1}),
    ({**NEWTON_METRE, "rad": -1}, {"rad": 1}, {"rad": 1, "s": -1}),
)
BY_NAME = {  # of units that an FMU names and does not define
    "N": Unit(NEWTON),
    "N.m": Unit(NEWTON_METRE),
    "m": Unit({"m": 1}),
    "m/s": Unit({"m": 1, "s": -1}),
    "rad": Unit({"rad": 1}),
    "rad/s": Unit({"rad": 1, "s": -1}),
}


@dataclass(frozen=True)
class Bond:
    """One direction in which two components push each other."""

    force: Connection
    position: Connection | None
    velocity: Connection | None
    factor: float = 1.0  # J in a unit of force times one of motion, as their sources give them

    @property
    def force_side(self) -> str:
        """The component that gives the force and takes the motion."""
        return self.force.source

    @property
    def motion_side(self) -> str:
        """The component that takes the force and gives the motion."""
        return self.force.target

    @property
    def motion(self) -> tuple[Connection, ...]:
        """The motion that comes back: position, velocity, or both in this order."""
        return tuple(c for c in (self.position, self.velocity) if c is not None)

    @property
    def title(self) -> str:
        """For people."""
        return f"{self.force.source_name} on {self.force.target_name}"


def find_bonds(
    declared: Sequence[BondSpec],
    connections: Sequence[Connection],
    seats: Sequence[Attachment],
    components: Mapping[str, Component],
) -> list[Bond]:
    """All bonds: those that a scene declares, and those that the units of single connections tell.

    Raises TouchdownError where one that is declared can be none.
    """
    recogniser = _Recogniser(components, connections)
    bonds = [recogniser.declared(spec) for spec in declared]
    taken: set[Connection] = set()
    for bond in bonds:
        recogniser.refuse_unusable(bond, taken, seats)
        taken |= {bond.force, *bond.motion}
    free = [c for c in connections if c not in taken]
    return [*bonds, *recogniser.recognised(free, seats)]


@dataclass(frozen=True)
class _Recogniser:
    """Finds bonds among single connections, by the units that their ends declare."""

    components: Mapping[str, Component]
    connections: Sequence[Connection]

    def declared(self, spec: BondSpec) -> Bond:
        """The bond that a scene declares. Raises TouchdownError where it can be none."""
        force, motion = self._of(spec.force), [self._of(wire) for wire in spec.motion]
        position = self._of(spec.position) if spec.position else None
        velocity = self._of(spec.velocity) if spec.velocity else None
        what = f"bond {force.source_name}"
        for c, kind in ((force, "force"), (position, "position"), (velocity, "velocity")):
            if c is not None and self._kind(c) not in ("", kind):
                raise TouchdownError(
                    f"{what}: {c.source_name} is given as {kind}, and its units say {self._kind(c)}; "
                    "name it so, or correct the units"
                )
        for c in (position, velocity, *motion):
            if c is not None and (c.source, c.target) != (force.target, force.source):
                raise TouchdownError(
                    f"{what}: {c.source_name} to {c.target_name} does not lead from {force.target} back to "
                    f"{force.source}, which the force comes from"
                )
        for place, c in enumerate(motion):
            if c in motion[:place]:
                raise TouchdownError(f"{what}: {c.source_name} stands in it twice; leave one out")
            kind = self._kind(c) or (("position", "velocity")[place] if len(motion) == 2 else "")
            if kind == "position" and position is None:
                position = c
            elif kind == "velocity" and velocity is None:
                velocity = c
            else:
                raise TouchdownError(
                    f"{what}: its unit does not say whether {c.source_name} is position or velocity; "
                    f'write bond = [{{force = ["{force.source_name}", "{force.target_name}"], '
                    f'position = ["{c.source_name}", "{c.target_name}"]}}], or velocity = [...]'
                )
        bond = self._bond(force, position, velocity)
        if not self._same_power(bond):
            raise TouchdownError(
                f"{what}: its force and its motion are scaled so that the power that {force.source} gives "
                f"is not what {force.target} takes; give both the same factor"
            )
        return bond

    def refuse_unusable(
        self, bond: Bond, taken: Collection[Connection], seats: Sequence[Attachment]
    ) -> None:
        """Raise TouchdownError where a bond that is declared cannot cross as one."""
        ends = {bond.force_side, bond.motion_side}
        if len(ends) == 1:
            raise TouchdownError(
                f"bond {bond.title} leads back to {bond.force_side}; it needs two components"
            )
        for c in (bond.force, *bond.motion):
            if c in taken:
                raise TouchdownError(f"bond {bond.title}: {c.target_name} is of another bond already")
            if self._constant(c):
                raise TouchdownError(f"bond {bond.title}: {c.source_name} does not change; remove the bond")
        for a in seats:
            if a.bearing in ends:
                raise TouchdownError(
                    f"bond {bond.title}: {a.bearing} is a bearing, {a.title}, and a bearing has no bonds; "
                    "attach its port to a body's, or move the bond's wires to connect"
                )

    def _constant(self, c: Connection) -> bool:
        return self.components[c.source].variable(c.output).constant

    def _of(self, wire: Wire) -> Connection:
        return next(
            c for c in self.connections if (c.source_name, c.target_name) == (wire.source, wire.target)
        )

    def recognised(self, connections: Sequence[Connection], seats: Sequence[Attachment]) -> Iterator[Bond]:
        """All that are no matter of opinion.

        Between two components: one force of its kind one way, and of its motion at most one position and
        one velocity back. A bearing carries its bodies through a whole macro step, from where that begins:
        it cannot be stepped in parts, and has no bonds.
        """
        bearings = {a.bearing for a in seats}
        live = [c for c in connections if not bearings & {c.source, c.target} and not self._constant(c)]
        for giver, taker in dict.fromkeys((c.source, c.target) for c in live if c.source != c.target):
            there = [c for c in live if (c.source, c.target) == (giver, taker)]
            back = [c for c in live if (c.source, c.target) == (taker, giver)]
            for kind in KINDS:
                force, position, velocity = (
                    [c for c in wires if self._is(c, dimension)]
                    for wires, dimension in zip((there, back, back), kind, strict=True)
                )
                if len(force) == 1 and len(position) < 2 and len(velocity) < 2 and position + velocity:
                    bond = self._bond(force[0], next(iter(position), None), next(iter(velocity), None))
                    if self._same_power(bond):
                        yield bond

    def _is(self, c: Connection, dimension: Dimension) -> bool:
        ends = self._unit(c.source, c.output), self._unit(c.target, c.input)
        return all(unit is not None and dict(unit.exponents) == dict(dimension) for unit in ends)

    def _kind(self, c: Connection) -> str:
        """Whether a connection carries force, position or velocity; empty where its units do not tell."""
        for dimensions in KINDS:
            for kind, dimension in zip(("force", "position", "velocity"), dimensions, strict=True):
                if self._is(c, dimension):
                    return kind
        return ""

    def _unit(self, component: str, variable: str) -> Unit | None:
        name = self.components[component].variable(variable).unit
        unit = None if not name else self.components[component].units.get(name, BY_NAME.get(name))
        return unit if unit and unit.factor else None  # a factor of 0 measures nothing

    def _same_power(self, bond: Bond) -> bool:
        """Whether both ends speak of the same power, in any units and scales."""
        force = abs(self._gain(bond.force))
        return all(abs(force - abs(self._gain(c))) < 1e-9 * force for c in bond.motion)

    def _gain(self, c: Connection) -> float:
        """How many times larger, in SI, the target sees what it is given."""
        output, taken = self._unit(c.source, c.output), self._unit(c.target, c.input)
        ratio = taken.factor / output.factor if output and taken else 1.0
        return ratio * (c.scale[0] if c.scale else 1.0)

    def _bond(self, force: Connection, position: Connection | None, velocity: Connection | None) -> Bond:
        """With the power that the motion side gets."""
        bond = Bond(force, position, velocity)
        units = (self._unit(c.source, c.output) for c in (force, bond.motion[0]))
        factor = math.prod(unit.factor for unit in units if unit)
        return replace(bond, factor=self._gain(force) * factor)
