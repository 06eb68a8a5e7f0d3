"""Contacts at the sides of a ball, with its neighbours in the row or its pocket in the cage, over a kick.

The contacts that touch are gathered and their friction is found together. Each counts as a contact alone
(`bearings.contact.pair`): what its neighbours' friction does in the kick is taken from the kick before.

The normal forces N_i of a row of balls that push each other are solved together (`Chain`), as a ball
between two others feels both, and damping acts within a kick. Contact i closes at the rate s_i along n_i,
and with equal balls of mass m

    ds_i = e_i - h/m (2 N_i - n_(i-1).n_i N_(i-1) - n_i.n_(i+1) N_(i+1))

where e is what all other forces do in the kick h. Put into the line of contact i, with its damping c_i,
z_i = 2 h c_i/m and p_i = (3 + z_i) c_i h/m,

    (6 + z_i + 2 p_i) N_i - p_i (n_(i-1).n_i N_(i-1) + n_i.n_(i+1) N_(i+1))
        = (6 + z_i) (elastic_i + c_i s_i) + (3 + z_i) c_i e_i

which is tridiagonal. For a contact alone it is `pair.damped_normal`. Nothing pulls: a force below zero is
cut off where it arises.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import array, integer
from ..contact.friction import curve
from ..contact.laws import elastic_and_damping, elastic_energy, elastic_force
from ..contact.pair import OUTSIDE, ContactPlace, ForceLine, Squeeze, force_on, kick_of, rubbed, slip
from ..contact.passivity import middle_of, passive, settled_account
from ..contact.peaks import Largest
from .ball_set import MAX_BALLS
from .balls import largest_contact
from .friction import in_full_lanes, set_lines
from .micro_step import beat_of


@kernel
def rub_sides(contacts, count, friction, lines):
    """Set the friction (N) of those of `count` contacts that touch, their normal forces known.

    contacts: `SideContacts`; friction: a record; lines: `FrictionLines`, overwritten.
    """
    if contacts.touching > 0:
        set_lines(in_full_lanes(_gather(contacts, count, lines)), curve(friction), lines)
        _hand_back(contacts, count, lines)


@inlined
def _gather(contacts, count, lines):
    """Put those of `count` contacts that touch first in `lines`; returns how many there are."""
    k = 0
    for b in range(count):
        lines.normal[k], lines.sliding[k] = contacts.normal[b], contacts.sliding[b]
        lines.expected[k], lines.answer[k] = contacts.sliding[b] + contacts.driven[b], contacts.across[b]
        k += 1 if contacts.indentation[b] > 0.0 else 0  # else the next one takes the place
    return k


@inlined
def _hand_back(contacts, count, lines):
    """Set the friction (N) of those of `count` contacts that touch from their lines."""
    k = 0
    for b in range(count):
        if contacts.indentation[b] > 0.0:
            line = ForceLine(lines.start[k], lines.slope[k], lines.base[k])
            contacts.tangential[b] = force_on(line, contacts.across[b], contacts.driven[b])
            k += 1


@dataclass(frozen=True)
class SideContacts:
    """Contact of each ball with the next, or with the cage, at the last evaluation."""

    normal: tuple = array(MAX_BALLS)
    highest: tuple = array(MAX_BALLS)  # N, of the normal force in the kick; `normal` is its mean
    tangential: tuple = array(MAX_BALLS)
    indentation: tuple = array(MAX_BALLS)
    stiffness: tuple = array(MAX_BALLS)
    nx: tuple = array(MAX_BALLS)  # where it lies, as `bearings.contact.pair.ContactPlace`
    ny: tuple = array(MAX_BALLS)
    nz: tuple = array(MAX_BALLS)  # 0 in the plane
    first: tuple = array(MAX_BALLS)
    second: tuple = array(MAX_BALLS)
    sliding: tuple = array(MAX_BALLS)  # m/s, before the kick
    rate: tuple = array(MAX_BALLS)  # m/s, of the indentation, before the kick
    middle: tuple = array(MAX_BALLS)  # m/s, in the middle of the kick
    stored: tuple = array(MAX_BALLS)  # J, as `bearings.contact.passivity`
    damped: tuple = array(MAX_BALLS)  # N, what of the normal force is damping
    driven: tuple = array(MAX_BALLS)  # m/s, change of the sliding speed by all but its own friction
    across: tuple = array(MAX_BALLS)  # s/kg, as `bearings.contact.pair.Kick.across`
    touching: int = integer(0, "how many of them touch")


@kernel
def lay(contacts, b, place, sliding, rate, kick, law):
    """Remember ball `b`'s `ContactPlace` (m), its speeds (m/s) before the kick, and the `Kick`.

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
    """The `ContactPlace` of ball `b`'s contact."""
    return ContactPlace(c.nx[b], c.ny[b], c.indentation[b], c.first[b], c.second[b], 0.0)


@kernel
def ball_heat(contacts, b, h, first, second, side):
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
        c.stored[b], lost = settled_account(c.stored[b], c.indentation[b], taken)
        withheld += lost
    return withheld


@kernel
def highest(contacts, count, rows):
    """`Largest` of the contacts of `count` balls in the kick (m; N on one of the balls in `rows`)."""
    if contacts.touching == 0:
        return Largest(0.0, 0.0, 0, 0)
    return largest_contact(contacts.highest, contacts.indentation, count, rows)


@kernel
def stored_energy(contacts, law, count):
    """Energy (J) of one kind of contact of `count` balls; law: a record."""
    energy = 0.0
    for b in range(count):
        energy += elastic_energy(contacts.indentation[b], law)
    return energy


@dataclass(frozen=True)
class Chain:
    """Contacts of each ball with the next on their way through a kick."""

    elastic: tuple = array(MAX_BALLS)  # N
    base: tuple = array(MAX_BALLS)  # of the equation above: what is before N_i
    pull: tuple = array(MAX_BALLS)  # p_i; then what N_i gains with N_(i+1)
    free: tuple = array(MAX_BALLS)  # N, the right-hand side; then N_i without N_(i+1)


@kernel
def part_ways(contacts, b):
    """Ball `b` does not touch the next one in this kick; its force in the kick before is still known."""
    contacts.indentation[b] = -1.0


@kernel
def link(b, count, first, second, rates, place, law, answers, m):
    """Write the equation of ball `b` (`second`) and the next (`first`), which touch at a `place`.

    first, second: Motion (m, m/s, rad/s); rates: two Motion of accelerations (m/s2, rad/s2) in the kick
    before, of the next and of `b`; law: a record; answers: (1/kg) of the sliding speed to friction, and of
    a ball to a force.
    """
    c, chain = m.s.side, m.s.chain
    back, on = b - 1 if b > 0 else count - 1, after(b, count)
    beside = c.normal[back] * (c.nx[back] * place.nx + c.ny[back] * place.ny)
    beside += c.normal[on] * (c.nx[on] * place.nx + c.ny[on] * place.ny)
    last = c.tangential[b], c.normal[b] - 0.5 * beside
    kick = kick_of(beat_of(m), (answers[0], 2.0 * answers[1]), rates[0], rates[1], place, OUTSIDE, last)
    sliding, rate = slip(first, second, place, OUTSIDE)
    elastic, damping = elastic_and_damping(place.indentation, law)
    scale = place.indentation / (law.exponent + 1.0)
    elastic = passive(elastic, scale, c.stored[b], rate, kick.rate, kick.along, kick.beat)
    z = kick.along * damping
    chain.elastic[b] = elastic
    chain.pull[b] = 0.5 * (3.0 + z) * z
    chain.base[b] = 6.0 + z * (4.0 + z)
    chain.free[b] = (6.0 + z) * (elastic + damping * rate) + (3.0 + z) * damping * kick.rate
    lay(c, b, place, sliding, rate, kick, law)


@kernel
def set_normal_forces(contacts, chain, count):
    """Set the normal forces (N) of all contacts, those of balls apart to zero."""
    if contacts.touching == 0:  # of most kicks
        for b in range(count):
            note_apart(contacts, b)
        return
    gap = _first_gap(contacts, count)
    # A full circle is cut at ball 0, where the forces of the kick before count.
    held, gain = (contacts.normal[count - 1] if gap < 0 else 0.0), 0.0
    beyond = contacts.normal[0] if gap < 0 else 0.0
    b = count - 1 if gap < 0 else gap
    for _ in range(count):
        back, b = b, after(b, count)
        if contacts.indentation[b] > 0.0:
            pull = chain.pull[b] * _alike(contacts, back, b)
            inverse = 1.0 / (chain.base[b] - pull * gain)
            held = (chain.free[b] + pull * held) * inverse
            gain = chain.pull[b] * _alike(contacts, b, after(b, count)) * inverse
        else:
            held, gain = 0.0, 0.0
        chain.free[b], chain.pull[b] = held, gain
    for _ in range(count):
        beyond = max(chain.free[b] + chain.pull[b] * beyond, 0.0)
        if contacts.indentation[b] > 0.0:
            contacts.normal[b], contacts.damped[b] = beyond, beyond - chain.elastic[b]
        else:
            note_apart(contacts, b)
        b = b - 1 if b > 0 else count - 1


@kernel
def after(b, count):
    """The ball after ball `b`."""
    return b + 1 if b + 1 < count else 0


@kernel
def _alike(contacts, b, k):
    """How much contacts `b` and `k` point the same way: n_b . n_k."""
    across = contacts.nx[b] * contacts.nx[k] + contacts.ny[b] * contacts.ny[k]
    return across + contacts.nz[b] * contacts.nz[k]


@kernel
def _first_gap(contacts, count):
    """A ball that does not touch the next one; -1: all do."""
    for b in range(count):
        if contacts.indentation[b] <= 0.0:
            return b
    return -1
