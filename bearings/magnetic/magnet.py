"""The magnets of a radial bearing: two axes of two opposite ones each, in differential driving mode.

The state of a coil is its flux linkage. Its force depends on that alone, and the current on flux linkage
and air gap, so that negative stiffness, back-EMF, saturation and slew follow from one equation:

    K = mu0 N^2 A / 4       i = lambda g / (2 K) + l_fe / (mu0 N) max(lambda / (N A) - B_s, 0)
    d lambda/dt = v - R i   F = lambda^2 / (4 K) cos(alpha)     g = s0 -+ u cos(alpha)

A pole stands at the angle alpha to its magnet's axis: a displacement u along the axis closes its gap by
u cos(alpha), and one across opens one pole as far as it closes the other. So F is the derivative of the
field's energy, and no work is lost between coils and rotor. Without saturation F = K i^2 / g^2 cos(alpha),
as in Schweitzer and Maslen, Magnetic Bearings (2009), chapter 4, who let the gap close by the whole of u:
their k_s is ours over cos(alpha). Saturated iron is as permeable as air. Leakage and hysteresis are left
out.

Eddy currents in thick sheets or solid iron add a reluctance that grows with the square root of the
frequency (the half-order model of Zhu, Knospe, Maslen, IEEE Trans. Magn. 41(4), 2005, 1248-1258):

    i = i_settled + c sqrt(d/dt) lambda        c = 1 / (L0 sqrt(w_e))        L0 = 2 K / s0

At w_e it is that of the air gaps. Of sheets of thickness d, permeability mu and conductivity sigma, where
the skin is thin, w_e = (4 s0 / (mu0 l_fe d))^2 mu / sigma. sqrt(s) is a sum of `EDDIES` short-circuited
windings, which store c r_k (lambda - x_k)^2 / 2 and make c r_k p_k (lambda - x_k)^2 of heat, and of one
without leakage, which makes c G (d lambda/dt)^2:

    sqrt(s) = G s + sum of r_k s / (s + p_k)        x_k' = p_k (lambda - x_k)

within 0.6 % of sqrt(j w) from 1 Hz to 10 kHz. Those that the spin induces in the rotor are left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import real
from .amplifier import set_point

MU0 = 4e-7 * math.pi  # V s/(A m)
BISECTIONS = 60  # to the rounding of a current
EDDIES = 8
EDDY_RATES = 0.753982237 * 5.2 ** np.arange(EDDIES)  # p_k, rad/s
EDDY_FACTORS = (1.0092, 0.4891, 0.5243, 0.5259, 0.5218, 0.5299, 0.5122, 0.6096) * np.sqrt(EDDY_RATES)  # r_k
EDDY_DIRECT = 0.00123224  # G, s^0.5; all for the least largest error
SMALLEST_GAP = 0.05  # of the centred journal's; nearer, the journal would have hit the magnets


@dataclass(frozen=True)
class Core:
    """Equal magnets, and their iron."""

    gap: float = real(0.6e-3, "m", "air gap of the centred journal", above=0.0)
    area: float = real(1e-4, "m2", "cross-section of a pole", above=0.0)
    turns: float = real(200.0, "1", "turns of a magnet's coil", above=0.0)
    flux_limit: float = real(1.2, "T", "flux density at which the iron saturates", above=0.0)
    iron_path: float = real(
        0.1, "m", "of the iron, which once it is saturated is as permeable as air", minimum=0.0
    )
    eddy_bandwidth: float = real(
        0.0,
        "rad/s",
        "where the reluctance by eddy currents in the iron is that of the air gaps; 0: none",
        minimum=0.0,
        shown="rad/s",
    )


@dataclass(frozen=True)
class Magnet(Core):
    """Four equal magnets: the first axis lies at `angle`, the second a quarter turn further."""

    pole_angle: float = real(
        math.pi / 8, "rad", "half the angle between a magnet's poles", minimum=0.0, maximum=1.5
    )
    angle: float = real(math.pi / 4, "rad", "of the first axis, from the horizontal")


@dataclass(frozen=True)
class Factors:
    """Of the force of an axis at the centre, without load and saturation."""

    current_factor: float = real(
        0.0, "N/A", "k_i, force per control current at the centre, not saturated", constant=True
    )
    displacement_factor: float = real(
        0.0,
        "N/m",
        "k_s, force against a displacement at the centre, without load and saturation; below zero",
        constant=True,
    )


@dataclass(frozen=True)
class Circuit(Factors):
    """Constants that follow from the magnets and the bias current."""

    factor: float = real(0.0, "N.m2/A2", "K of F = K i^2 / g^2")
    per_gap: float = real(0.0, "A/(V.s.m)", "current per flux linkage and air gap, 1/(2 K)")
    saturation: float = real(0.0, "V.s", "flux linkage at which the iron saturates")
    inductance: float = real(0.0, "V.s/A", "of a coil, with the journal centred")
    pull: float = real(0.0, "N/(V2.s2)", "force over the flux linkage squared")
    eddy: float = real(
        0.0, "A/(V.s0.5)", "c, current by eddy currents per half-order rate of the flux linkage"
    )
    pole: float = real(0.0, "1", "cosine of pole_angle: gap per displacement, force per poles' pull")
    cosine: float = real(0.0, "1", "of the first axis")
    sine: float = real(0.0, "1", "of the first axis")


@kernel
def lay_out_circuit(d, p, bias, pole):
    """Set the constants d (`Circuit`) of magnets p (`Core`) with a bias current (A); pole: cosine."""
    d.factor = 0.25 * MU0 * p.turns * p.turns * p.area
    d.per_gap, d.saturation = 0.5 / d.factor, p.flux_limit * p.turns * p.area
    d.inductance = 2.0 * d.factor / p.gap
    d.eddy = 1.0 / (d.inductance * math.sqrt(p.eddy_bandwidth)) if p.eddy_bandwidth > 0.0 else 0.0
    d.pole = pole
    d.pull = d.pole / (4.0 * d.factor)
    d.current_factor = 4.0 * d.factor * bias / squared(p.gap) * d.pole
    d.displacement_factor = -4.0 * d.factor * squared(bias) / (p.gap * p.gap * p.gap) * squared(d.pole)


@inlined
def current_of(flux, gap, p, d):
    """Current (A) that goes with a flux linkage (V s) over an air gap (m)."""
    current = flux * gap * d.per_gap
    if flux > d.saturation:
        current += p.iron_path / (MU0 * p.turns) * (flux / (p.turns * p.area) - p.flux_limit)
    return current


def current_slopes(flux, gap, p, d):
    """Of `current_of`: per flux linkage (A/(V s)) and per air gap (A/m)."""
    saturated = flux > p.flux_limit * p.turns * p.area
    iron = p.iron_path / (MU0 * p.turns * p.turns * p.area) if saturated else 0.0
    return 0.5 * gap / d.factor + iron, 0.5 * flux / d.factor


@kernel
def flux_of(current, gap, p, d):
    """Flux linkage (V s) that goes with a current (A, from 0) over an air gap (m)."""
    per_flux = 0.5 * gap / d.factor
    flux = current / per_flux
    linked = p.turns * p.area
    if flux <= p.flux_limit * linked:
        return flux
    iron = p.iron_path / (MU0 * p.turns)
    return (current + iron * p.flux_limit) / (per_flux + iron / linked)


@inlined
def gap_of(coil, displacements, p, d):
    """Mean air gap (m) of a coil (0 to 3: first axis +, -, second axis +, -), its axes displaced (m)."""
    u = d.pole * (displacements[0] if coil < 2 else displacements[-1])  # fixed places: others cost a third
    return max(p.gap - u if coil % 2 == 0 else p.gap + u, SMALLEST_GAP * p.gap)


@kernel
def centred_force(control, p, d, a):
    """Force (N) of an axis at rest, the journal centred, by its control current (A); a: `Amplifier`."""
    plus, _ = set_point(0, control, a)
    minus, _ = set_point(1, control, a)
    return d.pull * (squared(flux_of(plus, p.gap, p, d)) - squared(flux_of(minus, p.gap, p, d)))


@kernel
def holding_current(force, p, d, a):
    """Control current (A) by which an axis holds a force (N) at the centre; a: `Amplifier`.

    force/k_i while both coils carry current below every limit; else by bisection, since `centred_force`
    never falls. Of a force that the limits do not allow, the least current that gives the largest.
    """
    size = abs(force)
    linear = size / d.current_factor
    most = a.bias + linear
    unsaturated = flux_of(most, p.gap, p, d) <= p.flux_limit * p.turns * p.area
    if linear <= a.bias and most <= a.current_limit and unsaturated:
        return force / d.current_factor
    low, high = 0.0, a.bias + a.current_limit  # beyond which both coils are at a limit
    size = min(size, centred_force(high, p, d, a))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if centred_force(middle, p, d, a) < size:
            low = middle
        else:
            high = middle
    return math.copysign(high, force) if force != 0.0 else 0.0
