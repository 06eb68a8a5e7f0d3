"""Which part of a bearing takes the heat that arises in it.

Heat arises where two parts touch or within one, and contacts share theirs alike between the two:

    journal     1/2 bore
    inner       1/2 bore + 1/2 inner race + its own bending
    balls       1/2 inner race + 1/2 outer race + what arises among balls, and in the pockets of a cage
    outer       1/2 outer race

so that the heat of rolling goes by a quarter to the inner ring, by half to the balls, and by a quarter to
the outer ring. The even share is an assumption: equal metals that meet at equal speed take about that.
Where one law stands for both races of a ball, its heat arises at either alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.variables import real
from .. import seat

# Quadratures of a bearing: all heat that it makes (J), from `HEAT` that of each part, the work of sliding.
LOSS, HEAT = seat.OWN, seat.OWN + 1
JOURNAL, INNER, BALLS, OUTER, SLIDING = range(5)
SIZE = 5
assert SIZE < seat.OWN_QUADRATURES + 1


@dataclass(frozen=True)
class HeatReport:
    """Heat that each part has taken; together they are `energy.dissipated`."""

    journal: float = real(0.0, "J", "heat that went to the journal since the start", local=True)
    inner: float = real(
        0.0, "J", "heat that went to the inner ring, or to a bushing, since the start", local=True
    )
    balls: float = real(0.0, "J", "heat that went to balls and cage since the start", local=True)
    outer: float = real(0.0, "J", "heat that went to the outer ring since the start", local=True)


class Sources(NamedTuple):
    """Heat by where it arises, in W, or in J of a kick."""

    bore: float  # between journal and bore
    bending: float  # within the inner ring
    inner: float  # at the inner race
    outer: float  # at the outer race
    among: float  # between balls, or of balls in their pockets


@kernel
def add_heat(sources, to, first):
    """Add `Sources` to what the parts take in the array `to`, where their components start at `first`."""
    s = sources
    to[first + JOURNAL] += 0.5 * s.bore
    to[first + INNER] += 0.5 * (s.bore + s.inner) + s.bending
    to[first + BALLS] += 0.5 * (s.inner + s.outer) + s.among
    to[first + OUTER] += 0.5 * s.outer


@kernel
def set_rates(sources, sliding, dq, first):
    """Set in dq the rates of what the parts take (W), and of the work of sliding.

    sources: `Sources` (W); sliding: force between journal and bore times their sliding speed (W).
    """
    for i in range(first, first + SIZE):
        dq[i] = 0.0
    add_heat(sources, dq, first)
    dq[first + SLIDING] = sliding


@kernel
def report(q, first, m):
    """Outputs of the quadratures in the state q that start at `first` (J)."""
    o = m.o.heat
    o.journal, o.inner = q[first + JOURNAL], q[first + INNER]
    o.balls, o.outer = q[first + BALLS], q[first + OUTER]
    m.o.contact.sliding_work = q[first + SLIDING]
