"""The lines of friction (`bearings.contact.kick.Line`) of all contacts that press, found together.

Of a bearing's balls few touch both races at a time, and a line costs more than all else at a contact. So
those that press are gathered from both races, one behind the other, and what comes of them is handed back:
eight of them become one pass of vector code, however they lie. The passes are short ones, each over all
contacts, as one long chain of operations would keep the processor waiting for its own results.
"""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings.contact.friction import Rises, rises
from touchdown.bearings.contact.kick import NO_LINE, line_at, spot
from touchdown.bearings.rolling.balls import MOST_BALLS
from touchdown.modelkit.kernel import kernel, woven
from touchdown.modelkit.variables import array

LANES = 8  # contacts that are computed at once, as vectors of 8 or two of 4
ROOM = 2 * MOST_BALLS  # a multiple of it


@dataclass(frozen=True)
class FrictionLines:
    """Contacts that press at both races, what their friction hangs on, and its `Line`."""

    normal: tuple = array(ROOM)  # N
    sliding: tuple = array(ROOM)  # m/s, before the kick
    expected: tuple = array(ROOM)  # m/s, after it, without their own friction
    answer: tuple = array(ROOM)  # s/kg, of the sliding speed to it
    spot: tuple = array(ROOM)  # m/s, where the kick is expected to end
    last: tuple = array(ROOM)  # `Rises` there
    flat: tuple = array(ROOM)
    steep: tuple = array(ROOM)
    faded: tuple = array(ROOM)
    start: tuple = array(ROOM)  # N
    slope: tuple = array(ROOM)  # N s/m
    base: tuple = array(ROOM)


@woven
def gather(k, count, answer, race, lines):
    """Put those of `count` contacts at a `race` (Rubbed) that press behind the first `k` of `lines`.

    answer: s/kg, of a sliding speed there to friction. Returns how many lines there are.
    """
    for b in range(count):
        lines.normal[k], lines.sliding[k] = race.normal[b], race.sliding[b]
        lines.expected[k], lines.answer[k] = race.expected[b], answer
        k += 1 if race.normal[b] > 0.0 else 0  # else the next one takes the place
    return k


@woven
def draw(count, law, lines):
    """Set start, slope and base of `count` lines; law: a `Curve`."""
    for k in range(count):
        lines.spot[k] = spot(lines.expected[k], lines.answer[k], lines.normal[k], law)
    for k in range(count):
        risen = rises(lines.spot[k], law)
        lines.last[k], lines.flat[k] = risen.last, risen.flat
        lines.steep[k], lines.faded[k] = risen.steep, risen.faded
    for k in range(count):
        risen = Rises(lines.last[k], lines.flat[k], lines.steep[k], lines.faded[k])
        line = line_at(lines.spot[k], risen, lines.sliding[k], lines.answer[k], lines.normal[k], law)
        lines.start[k], lines.slope[k], lines.base[k] = line.start, line.slope, line.base


@woven
def hand_back(k, count, race, lines):
    """Set the lines of `count` contacts at a `race` (Rubbed), which begin behind the first `k` of `lines`.

    Returns where those of the next race begin.
    """
    for b in range(count):
        presses = race.normal[b] > 0.0
        race.start[b] = lines.start[k] if presses else NO_LINE.start
        race.slope[b] = lines.slope[k] if presses else NO_LINE.slope
        race.base[b] = lines.base[k] if presses else NO_LINE.base
        k += 1 if presses else 0
    return k


@kernel
def in_full_lanes(count):
    """The next multiple of `LANES`: what is left over takes as long alone as in company."""
    return (count + LANES - 1) // LANES * LANES
