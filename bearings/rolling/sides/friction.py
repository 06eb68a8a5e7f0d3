"""Friction of contacts at the balls' sides, of all that touch together.

Each is a contact alone (`bearings.contact.kick`): what its neighbours' friction does in the kick is taken
from the kick before.
"""

from __future__ import annotations

from touchdown.bearings.contact.friction import curve
from touchdown.bearings.contact.kick import Line, force_on
from touchdown.bearings.rolling.rubbing.lines import draw, in_full_lanes
from touchdown.modelkit.kernel import kernel, woven


@kernel
def rub_sides(contacts, count, friction, lines):
    """Set the friction (N) of those of `count` contacts that touch, their normal forces known.

    contacts: `SideContacts`; friction: a record; lines: `FrictionLines`, overwritten.
    """
    if contacts.touching > 0:
        draw(in_full_lanes(_gather(contacts, count, lines)), curve(friction), lines)
        _hand_back(contacts, count, lines)


@woven
def _gather(contacts, count, lines):
    """Put those of `count` contacts that touch first in `lines`; returns how many there are."""
    k = 0
    for b in range(count):
        lines.normal[k], lines.sliding[k] = contacts.normal[b], contacts.sliding[b]
        lines.expected[k], lines.answer[k] = contacts.sliding[b] + contacts.driven[b], contacts.across[b]
        k += 1 if contacts.indentation[b] > 0.0 else 0  # else the next one takes the place
    return k


@woven
def _hand_back(contacts, count, lines):
    """Set the friction (N) of those of `count` contacts that touch from their lines."""
    k = 0
    for b in range(count):
        if contacts.indentation[b] > 0.0:
            line = Line(lines.start[k], lines.slope[k], lines.base[k])
            contacts.tangential[b] = force_on(line, contacts.across[b], contacts.driven[b])
            k += 1
