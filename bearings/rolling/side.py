"""Contacts of each ball with the next one, or with its pocket in the cage."""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings.rolling.balls import MOST_BALLS
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import array


@dataclass(frozen=True)
class SideContacts:
    """Contact of each ball with the next, or with the cage, at the last evaluation."""

    normal: tuple = array(MOST_BALLS)
    tangential: tuple = array(MOST_BALLS)
    indentation: tuple = array(MOST_BALLS)
    stiffness: tuple = array(MOST_BALLS)


@kernel
def note(contacts, b, press, indentation, law):
    """Remember the contact of ball `b`: `press` (Press: N) at an `indentation` (m); law: a record."""
    contacts.normal[b] = press.normal
    contacts.tangential[b] = press.tangential
    contacts.indentation[b] = indentation
    contacts.stiffness[b] = law.exponent * press.normal / indentation


@kernel
def note_apart(contacts, b):
    """Remember that ball `b` has no contact (0 N)."""
    contacts.normal[b], contacts.tangential[b] = 0.0, 0.0
    contacts.indentation[b], contacts.stiffness[b] = -1.0, 0.0


@kernel
def largest(contacts, count, rows):
    """(Normal force on one of `rows` (N), indentation (m), ball) of the most loaded of `count`; 0: none."""
    force, indentation, ball = 0.0, 0.0, 0
    for b in range(count):
        if contacts.normal[b] > force:
            force, ball = contacts.normal[b], b
        indentation = max(indentation, contacts.indentation[b])
    return force / rows, indentation, ball


@kernel
def stored(contacts, law, count):
    """Energy (J) of one kind of contact of `count` balls; law: a record."""
    energy = 0.0
    for b in range(count):
        depth = contacts.indentation[b]
        if depth > 0.0:
            energy += law.stiffness * depth ** (law.exponent + 1.0) / (law.exponent + 1.0)
    return energy
