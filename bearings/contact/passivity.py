"""Contacts that cannot make energy: each gives back no more than it has taken.

A stiff contact that a leapfrog step samples at h w of 0.8 returns some per cent more or less energy than
it took, at every hit. Without damping that is a random walk of the bodies' energy, and balls that rattle
for seconds gain it without bound. So each contact keeps an account, as passivity control does in haptics
(Hannaford and Ryu, IEEE Transactions on Robotics and Automation 18 (2002), 1-10): `stored`, the energy (J)
that its elastic force has taken from the bodies since they met. A kick of k seconds with the force f gives
them

    -f k (u - a k f/2)        u: closing speed before the kick and half of what other forces do to it
                              a: inverse masses along the normal, summed

Where that is more than what is stored, the force is cut to the root

    f = (u + sqrt(u^2 + 2 a stored))/(a k)

that gives back just that (`passive`). Momentum is kept, as the force acts on both bodies. What other forces
do in the kick is known only after it. The account is then settled exactly, with the speeds as they were
(`settled_account`), and the next hit pays a debt. What is left when the bodies part was withheld from
them: numerical dissipation, which is booked as such. Steps that resolve the hit withhold nothing.

Bodies that stay pressed, as balls are by their orbit, would still swing ever harder on what the contact
holds, where steps vary. So it keeps a reserve while they stay, and gives back at most half of what the law
asks for while it holds less than most (`ELASTIC_RESERVE`) of

    f (d/(n + 1) + delta)        delta: way from the indentation d to the middle of the next drift

which is the elastic energy there, less that of the way: for equal steps on a linear contact it is what the
leapfrog method itself leaves in it. A swing can then draw a tenth of what presses the bodies, no more.

Without a kick (adaptive steps, laws as they stand) the force is the law's.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.kernel import inlined

# Of the energy by the law; what is stored swings about it by some per cent at h w of 0.8
ELASTIC_RESERVE = 0.9
MIN_KICK = 1e-300  # s, and s/kg; stands for no kick at all, over which nothing is given


class Beat(NamedTuple):
    """A kick and what follows it; zero: none, the laws as they stand."""

    kick: float  # s
    drift: float  # s, half of the drift that follows; 0: the span ends


NO_BEAT = Beat(0.0, 0.0)


@inlined
def passive(elastic, scale, stored, rate, others, answer, beat):
    """The force (N) of a contact whose law asks for `elastic` (N), over the kick of a `Beat`.

    scale: indentation over n + 1, the law's exponent (m); stored: J, negative: a debt; rate: of the
    indentation before the kick, others: its change by other forces (m/s); answer: a k above (s/kg).
    """
    closing = rate + 0.5 * others
    released = elastic * beat.kick * (0.5 * answer * elastic - closing)
    left = elastic * (scale + beat.drift * (rate + others - answer * elastic))
    share = ELASTIC_RESERVE if beat.drift > 0.0 else 0.0  # no branch: loops over balls are vector code
    allowed = min(max(stored, 0.0), max(stored - share * max(left, 0.0), 0.5 * released))
    # the two quotients are the same for all contacts of a race, and leave the loop over them
    gain, inverse = 2.0 * answer / max(beat.kick, MIN_KICK), 1.0 / max(answer, MIN_KICK)
    root = math.sqrt(max(closing * closing + gain * allowed, 0.0))
    within = max((closing + root) * inverse, 0.0)
    return min(within, elastic) if released > allowed else elastic


@inlined
def middle_of(rate, middle, part):
    """Closing speed (m/s) in the middle of a kick that is `part` of the one in which `middle` was found.

    rate: before the kick (m/s).
    """
    return rate + part * (middle - rate)


@inlined
def settled_account(stored, indentation, taken):
    """(Energy in the account, energy withheld) (J) after a kick in which the contact took `taken` (J).

    indentation: in the kick (m); bodies apart have nothing stored.
    """
    total = stored + taken
    withheld = total if indentation <= 0.0 and total > 0.0 else 0.0
    return total - withheld, withheld
