"""Contacts of each ball with the next one, or with its pocket in the cage."""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings.contact.laws import elastic_energy, elastic_force
from touchdown.bearings.contact.pair import Place, Squeeze, rubbed, slip
from touchdown.bearings.contact.passivity import middle_of, settled
from touchdown.bearings.contact.peaks import Largest
from touchdown.bearings.rolling.balls import MOST_BALLS, largest
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import array, integer


@dataclass(frozen=True)
class SideContacts:
    """Contact of each ball with the next, or with the cage, at the last evaluation."""

    normal: tuple = array(MOST_BALLS)
    highest: tuple = array(MOST_BALLS)  # N, of the normal force in the kick; `normal` is its mean
    tangential: tuple = array(MOST_BALLS)
    indentation: tuple = array(MOST_BALLS)
    stiffness: tuple = array(MOST_BALLS)
    nx: tuple = array(MOST_BALLS)  # where it lies, as `bearings.contact.pair.Place`
    ny: tuple = array(MOST_BALLS)
    first: tuple = array(MOST_BALLS)
    second: tuple = array(MOST_BALLS)
    sliding: tuple = array(MOST_BALLS)  # m/s, before the kick
    rate: tuple = array(MOST_BALLS)  # m/s, of the indentation, before the kick
    middle: tuple = array(MOST_BALLS)  # m/s, in the middle of the kick
    stored: tuple = array(MOST_BALLS)  # J, as `bearings.contact.passivity`
    damped: tuple = array(MOST_BALLS)  # N, what of the normal force is damping
    driven: tuple = array(MOST_BALLS)  # m/s, change of the sliding speed by all but its own friction
    across: tuple = array(MOST_BALLS)  # s/kg, as `bearings.contact.kick.Kick.across`
    touching: int = integer(0, "how many of them touch")


@kernel
def lay(contacts, b, place, sliding, rate, kick, law):
    """Remember that ball `b` touches at a `Place` (m), its speeds (m/s) before the kick, and the `Kick`.

    law: a record.
    """
    c = contacts
    c.stiffness[b] = law.exponent * elastic_force(place.indentation, law) / place.indentation
    c.nx[b], c.ny[b], c.first[b], c.second[b] = place.nx, place.ny, place.first, place.second
    c.indentation[b], c.sliding[b], c.rate[b] = place.indentation, sliding, rate
    c.driven[b], c.across[b] = kick.sliding, kick.across
    c.touching += 1


@kernel
def press_of(contacts, b, side, law):
    """The `Press` (N, N m, m/s) of ball `b`'s contact, its forces known; side: as in `pair`; law: a record.

    Linear damping pushes at once where bodies meet, at the speed before the kick, and least at its end.
    """
    c = contacts
    c.highest[b] = max(c.normal[b], law.viscous * c.rate[b])
    squeezed = Squeeze(c.sliding[b], c.rate[b], c.normal[b], c.damped[b])
    return rubbed(_place_of(c, b), side, squeezed, c.tangential[b])


@kernel
def _place_of(c, b):
    """The `Place` of ball `b`'s contact."""
    return Place(c.nx[b], c.ny[b], c.indentation[b], c.first[b], c.second[b], 0.0)


@kernel
def heat_of(contacts, b, h, first, second, side):
    """Heat (W) of ball `b`'s contact over a kick of h (s).

    first, second: Motion of the bodies with accelerations (m/s2, rad/s2) for velocities; side: as in
    `pair`.
    """
    c = contacts
    sliding, rate = slip(first, second, _place_of(c, b), side)
    c.middle[b] = c.rate[b] + 0.5 * h * rate
    return c.damped[b] * c.middle[b] - c.tangential[b] * (c.sliding[b] + 0.5 * h * sliding)


@kernel
def note_apart(contacts, b):
    """Remember that ball `b` has no contact (0 N)."""
    contacts.normal[b], contacts.highest[b], contacts.tangential[b] = 0.0, 0.0, 0.0
    contacts.indentation[b], contacts.stiffness[b] = -1.0, 0.0


@kernel
def all_apart(contacts, count):
    """`note_apart` of all `count` balls."""
    for b in range(count):
        note_apart(contacts, b)


@kernel
def fill_sides(contacts, law, count):
    """Have the accounts of `count` contacts hold what their law, a record, has stored."""
    for b in range(count):
        contacts.stored[b] = elastic_energy(contacts.indentation[b], law)


@kernel
def settle_sides(contacts, count, kick, part):
    """Settle the accounts of `count` contacts after a `kick` (s); returns what they withheld (J).

    part: of the kick in which the forces were found.
    """
    withheld, c = 0.0, contacts
    for b in range(count):
        if c.indentation[b] <= 0.0 and c.stored[b] <= 0.0:  # apart for longer
            continue
        taken = 0.0
        if c.indentation[b] > 0.0:
            taken = kick * (c.normal[b] - c.damped[b]) * middle_of(c.rate[b], c.middle[b], part)
        c.stored[b], lost = settled(c.stored[b], c.indentation[b], taken)
        withheld += lost
    return withheld


@kernel
def highest(contacts, count, rows):
    """`Largest` of the contacts of `count` balls in the kick (m; N on one of the balls in `rows`)."""
    if contacts.touching == 0:
        return Largest(0.0, 0.0, 0, 0)
    return largest(contacts.highest, contacts.indentation, count, rows)


@kernel
def stored(contacts, law, count):
    """Energy (J) of one kind of contact of `count` balls; law: a record."""
    energy = 0.0
    for b in range(count):
        energy += elastic_energy(contacts.indentation[b], law)
    return energy
