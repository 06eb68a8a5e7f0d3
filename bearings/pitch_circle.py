"""A ball whose centre runs on the pitch circle, between both races: what the simplified models share.

One spring in series stands for both contacts (2.5, 2.6). With n the outward and t = (-n_y, n_x) the
tangential direction at the ball, e the ring's place from the bearing's middle, F the force of the spring
and s_i, s_o the sliding speeds at the inner and the outer race:

    F_o = F + r_m m gamma'^2                                                                       (2.9)
    along t, on the ball:    mu(s_i) F + mu(s_o) F_o - F (e . t)/r_m

The last term is that of a ball driven into the narrowing gap; the source leaves it out, and without it
the model creates energy.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from bearings.contact import elastic_force
from bearings.friction import coefficient
from modelkit.kernel import kernel
from modelkit.variables import real


class Gap(NamedTuple):
    """The inner ring as balls meet it: place from the middle (m), velocity (m/s), spin (rad/s)."""

    ex: float
    ey: float
    ux: float
    uy: float
    spin: float


class Pressed(NamedTuple):
    """What happens at one ball: loads in N, heat in W."""

    force: float  # between the rings
    elastic: float
    indentation: float  # approach of the rings, m
    inner: float  # friction of the inner race on the ball, along t
    outer: float  # friction of the outer race on the ball, along t
    wedge: float  # of the narrowing gap on the ball, against t
    lever: float  # of the inner contact from the ring's centre, m
    heat: float


@dataclass(frozen=True)
class LoadedBalls:
    """Balls pressed by both rings, at the last evaluation."""

    loaded: float = real(0.0, "1", "how many")
    force: float = real(0.0, "N", "largest")
    indentation: float = real(0.0, "m", "largest")
    energy: float = real(0.0, "J", "stored in the contacts")


@kernel
def between_races(gap, c, s, orbit, spin, rm, m):
    """A ball at the angle of cosine c and sine s, that orbits and spins (rad/s) on the radius rm (m)."""
    d = m.d
    rb, law = d.ball_radius, d.race
    v = rm * orbit
    force, elastic, inner, wedge, heat, lever = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    indentation = gap.ex * c + gap.ey * s - m.p.balls.play
    if indentation > 0.0:
        rate = gap.ux * c + gap.uy * s
        elastic = elastic_force(indentation, law)
        force = max(elastic + law.damping * indentation * rate, 0.0)
        lever = d.inner_radius - gap.ex * c - gap.ey * s  # the ring's centre stands off by e
        sliding = gap.spin * lever + gap.uy * c - gap.ux * s - v + rb * spin
        inner = coefficient(sliding, d.race_friction) * force
        wedge = elastic * (gap.ey * c - gap.ex * s) / rm
        heat = inner * sliding + (force - elastic) * rate
    back = -(v + rb * spin)
    outer = coefficient(back, d.race_friction) * (force + rm * d.mass * orbit * orbit)
    return Pressed(force, elastic, indentation, inner, outer, wedge, lever, heat + outer * back)


@kernel
def note(s, ball):
    """Count a loaded ball in `s` (LoadedBalls); ball: Pressed."""
    s.loaded += 1.0
    s.energy += 0.4 * ball.elastic * ball.indentation
    if ball.force > s.force:
        s.force = ball.force
    if ball.indentation > s.indentation:
        s.indentation = ball.indentation


@kernel
def clear(s):
    """Forget the loaded balls."""
    s.loaded, s.force, s.indentation, s.energy = 0.0, 0.0, 0.0, 0.0
