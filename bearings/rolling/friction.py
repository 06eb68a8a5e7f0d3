"""Friction of the balls at both races and of the journal in the bore, over a kick.

Each contact that presses has a line of friction (`contact.pair.ForceLine`). Of a bearing's balls few
touch both races at a time, and a line costs more than all else at a contact. So those that press are
gathered from both races, one behind the other, and the results are handed back: eight of them become one
pass of vector code, however they lie. The passes are short ones, each over all contacts, as one long chain
of operations would keep the processor waiting for its own results.

A ball's two contacts share its velocity and its spin, and all inner contacts and the bore share the ring's,
so they are solved together (`bearings.contact.pair` has one contact alone). With f_o, f_i the friction on a
ball along t, e the changes of the sliding speeds by all other forces, and Delta the ring's change of
velocity,

    ds_o = e_o + w_oo f_o + w_oi f_i
    ds_i = e_i + w_io f_o + w_ii f_i - J . Delta            J = (t_x, t_y, lever)

Each ball's two equations give f_i = held + gain J . Delta; put into the ring's three,

    (M + sum gain h J J^T) Delta = h (F - sum held J)

where F is all else that acts on it. The bore is one more contact of that form.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import array, group
from ..contact.friction import Rises, rises
from ..contact.pair import NO_LINE, line_at, spot
from .ball_set import MAX_BALLS
from .bending import BendingMemory

LANES = 8  # contacts that are computed at once, as vectors of 8 or two of 4
ROOM = 2 * MAX_BALLS  # a multiple of it


@dataclass(frozen=True)
class FrictionLines:
    """Contacts that press at both races, what their friction depends on, and its `Line`."""

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


@inlined
def gather_pressing(k, count, answer, race, lines):
    """Put those of `count` contacts at a `race` (Rubbed) that press behind the first `k` of `lines`.

    answer: s/kg, of a sliding speed there to friction. Returns how many lines there are.
    """
    for b in range(count):
        lines.normal[k], lines.sliding[k] = race.normal[b], race.sliding[b]
        lines.expected[k], lines.answer[k] = race.expected[b], answer
        k += 1 if race.normal[b] > 0.0 else 0  # else the next one takes the place
    return k


@inlined
def set_lines(count, law, lines):
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


@inlined
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


@dataclass(frozen=True)
class RubbedRace:
    """All balls at one race, at the last evaluation, and their friction on its way through a kick."""

    normal: tuple = array(MAX_BALLS)  # N
    tangential: tuple = array(MAX_BALLS)  # N, friction on the ball along t
    loss: tuple = array(MAX_BALLS)  # W, heat
    sliding: tuple = array(MAX_BALLS)  # m/s, of the ball over the race, before the kick
    driven: tuple = array(MAX_BALLS)  # m/s, its change by all but friction at races
    expected: tuple = array(MAX_BALLS)  # m/s, at which the kick would end but for its own friction
    start: tuple = array(MAX_BALLS)  # N, of the `Line` of its friction
    slope: tuple = array(MAX_BALLS)  # N s/m
    base: tuple = array(MAX_BALLS)
    held: tuple = array(MAX_BALLS)  # N, friction as the ring keeps its velocity
    gain: tuple = array(MAX_BALLS)  # N s/m, and for each m/s by which its race runs ahead
    shape: BendingMemory = group(BendingMemory)  # of the race; zero where it is rigid


class Rubbed(NamedTuple):
    """A `RubbedRace`, an array each; `tangential` is set anew, `loss` and all behind `driven` are set."""

    normal: object  # N
    tangential: object  # N
    loss: object  # W
    sliding: object  # m/s
    driven: object  # m/s
    expected: object  # m/s
    start: object  # N
    slope: object  # N s/m
    base: object
    held: object  # N
    gain: object  # N s/m


@kernel
def rubbed_of(race, n):
    """`Rubbed` (n,) as views of `race` (RubbedRace)."""
    r = race
    acting = r.normal[:n], r.tangential[:n], r.loss[:n], r.sliding[:n]
    lines = r.expected[:n], r.start[:n], r.slope[:n], r.base[:n]
    return Rubbed(*acting, r.driven[:n], *lines, r.held[:n], r.gain[:n])


class Inner(NamedTuple):
    """Where all balls touch the inner ring, an array each, and how that lies to their other contact."""

    nx: object  # outward direction
    ny: object
    lever: object  # m, from the ring's centre to the contact
    cross: object  # of the directions along both races


class Answers(NamedTuple):
    """Response of a ball's speeds along its races to friction over the kick (s/kg)."""

    outer: float  # its centre's, to that of the outer race
    inner: float
    spin: float  # its surface's by its spin


class RingChange(NamedTuple):
    """Change of the ring's motion over a kick."""

    x: float  # m/s
    y: float
    spin: float  # rad/s


class Bore(NamedTuple):
    """The journal in the bore, and the line of its friction over the kick."""

    nx: float
    ny: float
    lever: float  # m, from the ring's centre
    held: float  # N, friction on the journal as the ring keeps its velocity
    gain: float  # N s/m


class Push(NamedTuple):
    """All on the ring but friction, and the ring."""

    fx: float  # N
    fy: float
    moment: float  # N m
    mass: float  # kg
    inertia: float  # kg m2


class Around(NamedTuple):
    """Surroundings of the balls' friction over a kick."""

    moved: RingChange  # the ring, in the kick before
    push: Push
    bore: Bore


@kernel
def over_ring(nx, ny, lever, moved):
    """By how much (m/s) the ring's surface runs ahead, along t, at a contact of `lever` (m)."""
    return moved.y * nx - moved.x * ny + lever * moved.spin


@inlined
def _draw_lines(count, law, answers, moved, race, outer, inner, lines):
    """Set `held` and `gain` (n,) of both races with `count` balls.

    law: a `Curve`; moved: `RingChange` in the kick before; lines: `FrictionLines`.
    """
    _expect(answers, moved, race, outer, inner)
    pressing = gather_pressing(0, count, answers.outer + answers.spin, outer, lines)
    pressing = gather_pressing(pressing, count, answers.inner + answers.spin, inner, lines)
    set_lines(in_full_lanes(pressing), law, lines)
    hand_back(hand_back(0, count, outer, lines), count, inner, lines)
    _join(answers, race, outer, inner)


@inlined
def _expect(answers, moved, race, outer, inner):
    """Set the speeds (n,) at which the kick is expected to end but for each contact's own friction."""
    for b in range(len(race.nx)):
        w_oi = race.cross[b] * answers.inner - answers.spin
        w_io = race.cross[b] * answers.outer - answers.spin
        ahead = over_ring(race.nx[b], race.ny[b], race.lever[b], moved)
        outer.expected[b] = outer.sliding[b] + outer.driven[b] + w_oi * inner.tangential[b]
        inner.expected[b] = inner.sliding[b] + inner.driven[b] + w_io * outer.tangential[b] - ahead


@inlined
def _join(answers, race, outer, inner):
    """Set `held` and `gain` (n,) of both races from the lines of their contacts."""
    w_oo, w_ii = answers.outer + answers.spin, answers.inner + answers.spin
    for b in range(len(race.nx)):
        w_oi = race.cross[b] * answers.inner - answers.spin
        w_io = race.cross[b] * answers.outer - answers.spin
        slope_o, slope_i = outer.slope[b], inner.slope[b]
        alone_o = outer.start[b] - slope_o * outer.driven[b]
        alone_i = inner.start[b] - slope_i * inner.driven[b]
        d_o, d_i = outer.base[b] + slope_o * w_oo, inner.base[b] + slope_i * w_ii
        c_o, c_i = slope_o * w_oi, slope_i * w_io
        inverse = 1.0 / (d_o * d_i - c_o * c_i)
        outer.held[b] = (d_i * alone_o - c_o * alone_i) * inverse
        inner.held[b] = (d_o * alone_i - c_i * alone_o) * inverse
        outer.gain[b] = -c_o * slope_i * inverse
        inner.gain[b] = d_o * slope_i * inverse


@inlined
def _set_friction(answers, moved, race, outer, inner):
    """Set the friction (n,) at both races, and its heat; moved: `RingChange` in this kick."""
    w_oo, w_ii = answers.outer + answers.spin, answers.inner + answers.spin
    for b in range(len(race.nx)):
        w_oi = race.cross[b] * answers.inner - answers.spin
        w_io = race.cross[b] * answers.outer - answers.spin
        ahead = over_ring(race.nx[b], race.ny[b], race.lever[b], moved)
        f_o = outer.held[b] + outer.gain[b] * ahead
        f_i = inner.held[b] + inner.gain[b] * ahead
        ds_o = outer.driven[b] + w_oo * f_o + w_oi * f_i
        ds_i = inner.driven[b] + w_io * f_o + w_ii * f_i - ahead
        outer.tangential[b], inner.tangential[b] = f_o, f_i
        outer.loss[b] = -f_o * (outer.sliding[b] + 0.5 * ds_o)
        inner.loss[b] = -f_i * (inner.sliding[b] + 0.5 * ds_i)


@inlined
def _turn_ring(h, count, around, race, inner):
    """`RingChange`: what a kick of h (s) does to the ring, with `count` balls; around: `Around`."""
    push, bore = around.push, around.bore
    nx, ny, lever, gain, held = bore.nx, bore.ny, bore.lever, h * bore.gain, bore.held
    xx, yy, xy = gain * ny * ny, gain * nx * nx, -gain * nx * ny
    xw, yw, ww = -gain * ny * lever, gain * nx * lever, gain * lever * lever
    fx, fy, moment = push.fx + held * ny, push.fy - held * nx, push.moment - held * lever
    for b in range(count):
        nx, ny, lever, gain, held = race.nx[b], race.ny[b], race.lever[b], h * inner.gain[b], inner.held[b]
        along_x, along_y = -gain * ny, gain * nx
        xx -= along_x * ny
        xy += along_x * nx
        yy += along_y * nx
        xw += along_x * lever
        yw += along_y * lever
        ww += gain * lever * lever
        fx += held * ny
        fy -= held * nx
        moment -= held * lever
    return _solved(h, push.mass + xx, xy, push.mass + yy, xw, yw, push.inertia + ww, fx, fy, moment)


@kernel
def _solved(h, xx, xy, yy, xw, yw, ww, fx, fy, moment):
    """h times the solution of the ring's three symmetric equations, as `RingChange`."""
    xy_xx, xw_xx = xy / xx, xw / xx
    yy = yy - xy_xx * xy
    yw = yw - xy_xx * xw
    yw_yy = yw / yy
    fy = fy - xy_xx * fx
    spin = (moment - xw_xx * fx - yw_yy * fy) / (ww - xw_xx * xw - yw_yy * yw)
    y = fy / yy - yw_yy * spin
    x = fx / xx - xy_xx * y - xw_xx * spin
    return RingChange(h * x, h * y, h * spin)


@inlined
def rub(h, count, law, answers, around, race, outer, inner, lines):
    """Friction of `count` balls at both races and of the journal in the bore over a kick of h (s).

    law: `Curve` of the races; answers: `Answers`; around: `Around`; race: `Inner`; outer, inner: `Rubbed`,
    where friction and its heat are set; lines: `FrictionLines`, overwritten. Returns (friction on the
    journal along t (N), `RingChange`: what the kick does to the ring).
    """
    _draw_lines(count, law, answers, around.moved, race, outer, inner, lines)
    ring_change = _turn_ring(h, count, around, race, inner)
    _set_friction(answers, ring_change, race, outer, inner)
    bore = around.bore
    ahead = over_ring(bore.nx, bore.ny, bore.lever, ring_change)
    return bore.held + bore.gain * ahead, ring_change
