"""Contact forces that depend on velocity, over a kick of the leapfrog method.

A kick of h seconds changes the velocities of light bodies, their places held. Friction and damping answer
to that change within the kick: on a ball of half a gram friction does so within 0.1 us. So both are taken
implicitly, with the mean of the force over the kick. A contact's relative speed goes from s to s + ds with

    ds = e + w f        e: by all other forces        w = h J M^-1 J': the answer to its own force f

and the force is a line through its value at the speed s0 where the kick is expected to end
(`friction_line`):

    f = F(s0) + F'(s0) (s + theta ds - s0)        theta = (3 + z)/(6 + z)        z = -w F'(s0)

A linear law then decays by (6 - 2 z)/(6 + 4 z + z^2), the Pade approximant of exp(-z) that Radau IIA has:
of third order, and no step reverses a motion for long, however stiff the law (L-stable). With h = 0 all of
this is the law as it stands.

Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd ed., section IV.5.
"""

from __future__ import annotations

from typing import NamedTuple

from touchdown.bearings.contact.friction import height_and_slope, rises
from touchdown.bearings.contact.passivity import NO_BEAT, Beat
from touchdown.modelkit.kernel import woven


class Kick(NamedTuple):
    """What a contact's own forces meet over a kick; all zero: nothing, the laws as they stand."""

    beat: Beat
    across: float  # s/kg, answer of the sliding speed to friction
    along: float  # s/kg, answer of the approach to the normal force
    sliding: float  # m/s, change of the sliding speed by all other forces
    rate: float  # m/s, change of the indentation's rate by all other forces


STILL = Kick(NO_BEAT, 0.0, 0.0, 0.0, 0.0)


class Line(NamedTuple):
    """Mean force over a kick, for a change ds of the relative speed: (start - slope ds)/base.

    Left as a fraction, as whoever solves for ds divides anyway.
    """

    start: float  # N
    slope: float  # N s/m
    base: float


NO_LINE = Line(0.0, 0.0, 6.0)  # of a contact that does not press


@woven
def force_on(line, across, sliding):
    """The force (N) of a contact alone, from its `Line`; across (s/kg), sliding (m/s): as in `Kick`."""
    return (line.start - line.slope * sliding) / (line.base + line.slope * across)


@woven
def damped_normal(elastic, damping, rate, along, others):
    """Mean normal force (N) over a kick, never below zero, of a contact that approaches at `rate` (m/s).

    elastic: N; damping: N s/m; along (s/kg) and others (m/s): as `Kick.along` and `Kick.rate`.
    """
    z = along * damping
    force = (6.0 + z) * (elastic + damping * rate) + (3.0 + z) * damping * others
    return max(force / (6.0 + z * (4.0 + z)), 0.0)


@woven
def steepest(law):
    """Slope (s/m) of a `Curve` at rest."""
    return (law.dynamic + law.extra) * law.slope + law.g1 * (law.g2 - law.g3) + law.g6


@woven
def highest(law):
    """What a `Curve` does not exceed but for its viscous part, nor falls short of by much."""
    return law.dynamic + law.extra + 0.75 * law.g1


@woven
def spot(expected, answer, normal, law):
    """The speed (m/s) where a kick is expected to end under friction that rises linearly to its peak.

    expected: after the kick, without friction (m/s); answer: as `Kick.across`; law: a `Curve`.
    """
    reach, size = answer * normal, abs(expected)
    end = max(size / (1.0 + reach * steepest(law)), size - reach * highest(law))
    return end if expected >= 0.0 else -end


@woven
def line_at(speed, risen, sliding, answer, normal, law):
    """Friction of a contact under the force `normal` (N) over a kick, as a `Line`.

    speed: the kick's `spot` (m/s); risen: `Rises` there; sliding: speed before the kick (m/s).
    """
    mu, slope = height_and_slope(speed, risen, law)
    slope *= normal
    z = answer * slope
    return Line((6.0 + z) * (slope * (speed - sliding) - normal * mu), (3.0 + z) * slope, 6.0 + z)


@woven
def friction_line(sliding, expected, answer, normal, law):
    """`line_at` a kick's own `spot`, for a contact alone."""
    speed = spot(expected, answer, normal, law)
    return line_at(speed, rises(speed, law), sliding, answer, normal, law)
