"""Neighbours that push each other in a row of balls, all of them in one kick of the leapfrog method.

A ball between two others feels both, so with damping that acts within a kick (`bearings.contact.kick`) the
normal forces N_i of contacts side by side are solved together. Contact i closes at the rate s_i along n_i,
and with equal balls of mass m

    ds_i = e_i - h/m (2 N_i - n_(i-1).n_i N_(i-1) - n_i.n_(i+1) N_(i+1))

where e is what all other forces do in the kick h. Put into the line of contact i, with its damping c_i,
z_i = 2 h c_i/m and p_i = (3 + z_i) c_i h/m,

    (6 + z_i + 2 p_i) N_i - p_i (n_(i-1).n_i N_(i-1) + n_i.n_(i+1) N_(i+1))
        = (6 + z_i) (elastic_i + c_i s_i) + (3 + z_i) c_i e_i

which is tridiagonal. A contact alone is that of `kick.damped_normal`. Nothing pulls: a force below zero is
cut off as it is found.
"""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings.contact.laws import elastic_and_damping
from touchdown.bearings.contact.pair import OUTSIDE, kick_of, slip
from touchdown.bearings.contact.passivity import passive
from touchdown.bearings.rolling.balls import MOST_BALLS
from touchdown.bearings.rolling.micro_step import beat_of
from touchdown.bearings.rolling.sides.contact import all_apart, lay, note_apart
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import array


@dataclass(frozen=True)
class Chain:
    """Contacts of each ball with the next on their way through a kick."""

    elastic: tuple = array(MOST_BALLS)  # N
    base: tuple = array(MOST_BALLS)  # of the equation above: what is before N_i
    pull: tuple = array(MOST_BALLS)  # p_i; then what N_i gains with N_(i+1)
    free: tuple = array(MOST_BALLS)  # N, the right-hand side; then N_i without N_(i+1)


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
def share(contacts, chain, count):
    """Set the normal forces (N) of all contacts, those of balls apart to zero."""
    if contacts.touching == 0:  # of most kicks
        all_apart(contacts, count)
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
    return contacts.nx[b] * contacts.nx[k] + contacts.ny[b] * contacts.ny[k]


@kernel
def _first_gap(contacts, count):
    """A ball that does not touch the next one; -1: all do."""
    for b in range(count):
        if contacts.indentation[b] <= 0.0:
            return b
    return -1
