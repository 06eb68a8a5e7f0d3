"""What a scene joins by hand: single variables, and bonds, whose force and motion belong together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import Scale, to_si
from touchdown.master.scene.tables import entries, items, pairs, refuse_unknown, texts


class Wire(NamedTuple):
    """A single variable feeding another, COMPONENT.VARIABLE both."""

    source: str
    target: str
    scale: Scale | None = None  # factor and offset; None: as it is, in equal units


class BondSpec(NamedTuple):
    """A force one way and a motion the other, whose product is power.

    What a file gives as a list says by its units, or else by its order, which motion is which.
    """

    force: Wire
    position: Wire | None = None
    velocity: Wire | None = None
    motion: tuple[Wire, ...] = ()  # not told apart yet

    @property
    def wires(self) -> tuple[Wire, ...]:
        """All of them, the force first."""
        told = (self.force, self.position, self.velocity)
        return (*(wire for wire in told if wire is not None), *self.motion)


BOND = 'such as [["s1.f", "s2.f"], ["s2.x", "s1.x2"], ["s2.v", "s1.v2"]]'


def wires(value: object, where: str) -> tuple[Wire, ...]:
    """Pairs, some with factor and offset."""
    listed = [items(wire) for wire in items(value) or ()]
    if not isinstance(value, list) or None in listed:
        raise TouchdownError(f'{where} must be a list such as [["rotor.A.x", "probe.x"]]')
    return tuple(_wire(wire, where) for wire in listed if wire is not None)


def _wire(wire: Sequence[object], where: str) -> Wire:
    """Source and target, and where it is scaled, factor and offset."""
    ((source, target),) = pairs([list(wire[:2])], where)
    if len(wire) == 2:
        return Wire(source, target)
    if len(wire) != 4:
        raise TouchdownError(f"{where}: {wire}: after source and target, give factor and offset")
    what = f"{where}: {source} to {target}"
    return Wire(
        source, target, (to_si(wire[2], "1", f"{what}, factor"), to_si(wire[3], None, f"{what}, offset"))
    )


def bonds(value: object, where: str) -> tuple[BondSpec, ...]:
    """A bond as a list of its wires, the force first; or a list of bonds, of which each may be a table."""
    listed = items(value)
    if listed is None:
        raise TouchdownError(f"{where} must be a list of wires, the force first, {BOND}")
    return tuple(_bonds(listed, where))


def _bonds(listed: Sequence[object], where: str) -> Iterator[BondSpec]:
    if listed and all(texts(list(items(wire) or ())[:2]) for wire in listed):  # wires: a single bond
        yield _listed(listed, where)
        return
    for bond in listed:
        table = entries(bond)
        if table is None:
            yield _listed(items(bond) or (), where)
            continue
        refuse_unknown(table, ("force", "position", "velocity"), where)
        named = {kind: wires([wire], f"{where}.{kind}")[0] for kind, wire in table.items()}
        if "force" not in named or len(named) == 1:
            raise TouchdownError(f"{where} needs force, and position or velocity or both")
        yield BondSpec(named["force"], named.get("position"), named.get("velocity"))


def _listed(listed: Sequence[object], where: str) -> BondSpec:
    found = wires(list(listed), where)
    if not 2 <= len(found) <= 3:
        raise TouchdownError(
            f"{where} has {len(found)} wires; a bond is a force and one or two of motion, {BOND}"
        )
    return BondSpec(found[0], motion=found[1:])
