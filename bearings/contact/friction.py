"""Friction coefficients as odd functions of the sliding speed.

Three laws, chosen by `FrictionLaw.kind`:

COULOMB   (2.13), regularised: dynamic tanh(slope v)
STRIBECK  static/dynamic blend: (dynamic + (static - dynamic) exp(-(v/v_s)^2)) tanh(slope v)
MAKKAR    Makkar et al. (Halminen (2016), Fig 22):
          g1 (tanh g2 v - tanh g3 v) + g4 tanh g5 v + g6 v

Makkar's plateau g4 is `dynamic` and its slope g5 is `slope`. Its g1 follows from `static`, the peak,
unless it is given: `makkar_amplitude` finds the g1 whose peak is the static coefficient.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import Choices, choice, real

COULOMB = 0
STRIBECK = 1
MAKKAR = 2
LAWS = Choices(
    "FrictionLaw",
    ("coulomb", "stribeck", "makkar"),
    ("Coulomb, regularised", "static and dynamic, Stribeck", "Makkar et al."),
)

# of the search for the peak of Makkar's curve, from 0 to MAX_FADED_RATIO/g3 where all has risen that rises
MAX_FADED_RATIO = 3.0
FIRST_SAMPLE = 0.01  # sample, over the steeper of both rises
SAMPLE_RATIO = 1.5  # samples, as a ratio
MAX_NEWTON_STEPS = 60  # of Newton's method, held in a bracket
# Times the static coefficient; a larger g1 stands for a g2 that g3 all but cancels
MAX_STATIC_RATIO = 100.0


@dataclass(frozen=True)
class FrictionLaw:
    """Constants of a friction law; speeds in m/s."""

    kind: int = choice(MAKKAR, LAWS, "friction law")
    static: float = real(
        0.15,
        "1",
        "static coefficient, the peak of the curve",
        minimum=0.0,
        needs="kind == 1 or kind == 2 and g1 == 0",
        tunable=True,
    )
    dynamic: float = real(0.10, "1", "dynamic coefficient, the plateau (g4)", minimum=0.0, tunable=True)
    slope: float = real(100.0, "s/m", "steepness of the curve through zero speed (g5)", above=0.0)
    stribeck_speed: float = real(
        0.05, "m/s", "speed at which static friction has faded", above=0.0, needs="kind == 1"
    )
    g1: float = real(
        0.0, "1", "Makkar's g1; 0 takes it from the static coefficient", minimum=0.0, needs="kind == 2"
    )
    g2: float = real(100.0, "s/m", "Makkar's g2", above=0.0, needs="kind == 2")
    g3: float = real(10.0, "s/m", "Makkar's g3", above=0.0, needs="kind == 2")
    g6: float = real(1e-4, "s/m", "Makkar's g6, viscous", minimum=0.0, needs="kind == 2")


class FrictionCurve(NamedTuple):
    """Any of the laws as plain numbers, for loops that are to become vector code.

    g1 (tanh g2 v - tanh g3 v) + (dynamic + extra exp(-(v/v_s)^2)) tanh slope v + g6 v
    """

    g1: float
    g2: float
    g3: float
    dynamic: float
    extra: float
    faded: float  # 1/v_s^2
    slope: float
    g6: float


@kernel
def curve(law):
    """The `FrictionCurve` (1, s/m) of a `FrictionLaw` record."""
    g1 = law.g1 if law.kind == MAKKAR else 0.0
    g6 = law.g6 if law.kind == MAKKAR else 0.0
    extra = law.static - law.dynamic if law.kind == STRIBECK else 0.0
    faded = 1.0 / squared(law.stribeck_speed)
    return FrictionCurve(g1, law.g2, law.g3, law.dynamic, extra, faded, law.slope, g6)


@inlined
def saturation(x):
    """1 - exp(-x) for a number x >= 0, to 3e-13, from sums and products alone.

    A series for exp(-x/1024), squared ten times, written out: unlike a call of the mathematical library, or
    a loop, it becomes vector code. It is 0 at x = 0, and 1 to rounding beyond x = 40.
    """
    z = min(x, 40.0) * (1.0 / 1024.0)
    e = 1.0 - z * (1.0 - z * (1 / 2 - z * (1 / 6 - z * (1 / 24))))
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    e = e * e
    return 1.0 - e * e


class Rises(NamedTuple):
    """How far the exponentials of a `FrictionCurve` have run at a speed: 0 at rest, up to 1; 0: absent."""

    last: float  # of tanh slope v
    flat: float  # of tanh g3 v
    steep: float  # of tanh g2 v; `last` where both are the same
    faded: float  # of static friction


@inlined
def rises(speed, law):
    """`Rises` of a `FrictionCurve` at a speed (m/s). What a law does not have is not computed."""
    v = abs(speed)
    last = saturation(2.0 * law.slope * v)
    flat, steep, faded = 0.0, last, 0.0
    if law.extra != 0.0:
        faded = saturation(law.faded * v * v)
    if law.g1 != 0.0:
        flat = saturation(2.0 * law.g3 * v)
        if law.g2 != law.slope:
            steep = saturation(2.0 * law.g2 * v)
    return Rises(last, flat, steep, faded)


@inlined
def height_and_slope(speed, risen, law):
    """(Coefficient with its sign, derivative in s/m or zero where it falls) of a `FrictionCurve` at m/s.

    risen: `Rises` at that speed. The derivative leaves out that of the fading in Stribeck's law, which
    only falls. tanh(g v) = u/(2 - u) with u = 1 - exp(-2 g |v|).
    """
    last = risen.last
    level = law.dynamic + law.extra * (1.0 - risen.faded)
    if law.g1 == 0.0:
        plateau = last / (2.0 - last)
        value, slope = level * plateau, level * law.slope * (1.0 - plateau * plateau)
    else:
        flat = risen.flat
        both = 1.0 / ((2.0 - last) * (2.0 - flat))
        plateau, fall = last * (2.0 - flat) * both, flat * (2.0 - last) * both
        rise = plateau
        if law.g2 != law.slope:
            rise = risen.steep / (2.0 - risen.steep)
        value, slope = level * plateau, level * law.slope * (1.0 - plateau * plateau)
        value += law.g1 * (rise - fall)
        slope += law.g1 * (law.g2 * (1.0 - rise * rise) - law.g3 * (1.0 - fall * fall))
    value += law.g6 * abs(speed)
    return value if speed >= 0.0 else -value, max(slope + law.g6, 0.0)


@kernel
def coefficient_and_slope(speed, law):
    """Friction coefficient at sliding speed `speed` (m/s), with its sign, and its derivative (s/m).

    law: a record of `FrictionLaw`. The derivative is zero where the curve falls: it is what an implicit
    step needs.
    """
    course = curve(law)
    return height_and_slope(speed, rises(speed, course), course)


@kernel
def coefficient(speed, law):
    """Friction coefficient at sliding speed `speed` (m/s), with its sign."""
    return coefficient_and_slope(speed, law)[0]


@kernel
def slope(speed, law):
    """Derivative of the coefficient (s/m), zero where it falls."""
    return coefficient_and_slope(speed, law)[1]


@kernel
def _height(v, g1, law):
    """Makkar's curve at a speed v (m/s) with the amplitude g1; law: a record."""
    hump = math.tanh(law.g2 * v) - math.tanh(law.g3 * v)
    return g1 * hump + law.dynamic * math.tanh(law.slope * v) + law.g6 * v


@kernel
def _rise_and_bend(v, g1, law):
    """First and second derivative of `_height` in v (s/m, s2/m2)."""
    steep, flat, plateau = math.tanh(law.g2 * v), math.tanh(law.g3 * v), math.tanh(law.slope * v)
    d2, d3 = law.g2 * (1.0 - steep * steep), law.g3 * (1.0 - flat * flat)
    d5 = law.dynamic * law.slope * (1.0 - plateau * plateau)
    bend = g1 * (law.g2 * steep * d2 - law.g3 * flat * d3) + law.slope * plateau * d5
    return g1 * (d2 - d3) + d5 + law.g6, -2.0 * bend


@kernel
def _peak(g1, law):
    """Speed (m/s) at which `_height` is largest: the best of samples, and a zero of the rise beside it."""
    last = MAX_FADED_RATIO / law.g3
    peak, best = last, _height(last, g1, law)
    v = FIRST_SAMPLE / max(law.g2, law.slope)
    while v < last:
        height = _height(v, g1, law)
        if height > best:
            peak, best = v, height
        v *= SAMPLE_RATIO
    if peak == last and _rise_and_bend(last, g1, law)[0] >= 0.0:
        return last
    low, high, v = peak / SAMPLE_RATIO, min(peak * SAMPLE_RATIO, last), peak
    for _ in range(MAX_NEWTON_STEPS):
        rise, bend = _rise_and_bend(v, g1, law)
        if rise > 0.0:
            low = v
        else:
            high = v
        before, v = v, v - rise / bend
        if not low < v < high:
            v = 0.5 * (low + high)
        if not abs(v - before) > 1e-10 * v:  # the height's error is of the square of that
            break
    return v


@kernel
def makkar_amplitude(law):
    """The g1 with which Makkar's curve peaks at the static coefficient; 0 where it does without.

    law: a record. Not a number where g2 is so near to g3 that nothing in proportion does. The peak is the
    largest of functions that are linear in g1, so it is convex in it: Newton's steps, the first one aside,
    fall upon the root from above.
    """
    g1 = 0.0
    for _ in range(MAX_NEWTON_STEPS):
        v = _peak(g1, law)
        lacking = law.static - _height(v, g1, law)
        if g1 == 0.0 and lacking <= 0.0:
            return 0.0
        step = lacking / (math.tanh(law.g2 * v) - math.tanh(law.g3 * v))
        g1 += step
        if not abs(step) > 1e-15 * g1:
            break
    return g1 if g1 <= MAX_STATIC_RATIO * law.static else math.nan


@kernel
def derive(law):
    """Fill in g1 where it is left to follow from the static coefficient; law: a record, changed."""
    if law.kind == MAKKAR and law.g1 == 0.0:
        law.g1 = makkar_amplitude(law)


def law_problems(name: str) -> tuple[str, ...]:
    """Faults that `law_problem` may find in the law in the group `name` of a model's parameters."""
    return (
        f"{name}.g2 = {{0:g}} s/m must be above {name}.g3 = {{1:g}} s/m; "
        "the difference of their curves is what rises to the static coefficient",
        f"{name}.static = {{0:g}} does nothing with {name}.kind = 0 (Coulomb), whose "
        f"coefficient is {name}.dynamic = {{1:g}}; leave it out, or take {name}.kind = 1 "
        "(Stribeck) or 2 (Makkar)",
    )


@kernel
def law_problem(law, usual, numbers):
    """Why a law, a record, has no curve or not the one set: its number in `law_problems`, or 0.

    Coulomb's law has one coefficient. A static one beside it is refused where it was set to something else
    than `usual`, the default; as it stands by default it was not. numbers: of the message.
    """
    if law.kind == MAKKAR and law.g2 <= law.g3:
        numbers[0], numbers[1] = law.g2, law.g3
        return 1
    if law.kind == COULOMB and law.static != law.dynamic and law.static != usual:
        numbers[0], numbers[1] = law.static, law.dynamic
        return 2
    return 0
