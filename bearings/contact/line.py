"""How stiff a journal lies in its bore, from geometry: a line contact of two cylinders.

Halminen (2016) gives the contact a stiffness and an exponent (2.12) that are not from its parts. A
cylinder that lies along a length L in a bore of nearly its radius touches in a strip of half the width b,
under P/L a metre (Hertz; Johnson, Contact Mechanics, sections 4.2 and 5.6):

    q = P/L    1/R = 1/R_j - 1/(R_j + c)    1/E* = (1 - nu_j^2)/E_j + (1 - nu_r^2)/E_r
    b^2 = 4 q R/(pi E*)

The approach of two bodies in line contact depends on how deep they are. The journal is a cylinder in plane
strain, whose axis comes nearer to the strip (Johnson 5.57); of the ring counts what lies between strip and
the centroids of its sections, `depth` away, in plane stress; what bends beyond is the ring's own:

    approach = q (1 - nu_j^2)/(pi E_j) (2 ln(4 R_j/b) - 1) + q/(pi E_r) (2 ln(2 depth/b) - nu_r)

Kernels take the power law k d^n that has this force and this slope at a design load, and no logarithm at
every step. With n = 1.2, as of a 6904 at 400 N, it errs by 1 % from half to twice that load and by 6 % at
an eighth of it; near n = 1.5, of heavy rotors and small clearances, by 4 % at twice and 10 % at eight times
the load, always with too little force.

The last term has a maximum, where its bracket is 1; beyond, where the formula does not hold, the ring's
approach stays at that.

A journal that lies straight touches along the whole length. One that is tilted by a small angle touches at
an edge first. In slices that do not know of each other, each of the straight line's law k d^n/L, it is
pressed in there by s under

    P = k/(t L (n + 1)) (s^(n + 1) - max(s - t L, 0)^(n + 1))        t: the tilt

so n grows up to n + 1 while it touches on a part of its length. An estimate: the moment on the journal and
the first touch, t L/2 earlier, are left out, and a real tilt is not the same throughout a drop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import Choices, as_record, choice, real
from .laws import ContactLaw

AS_SET, FROM_GEOMETRY = range(2)
LAWS = Choices(
    "ContactStiffness",
    ("power", "line"),
    ("stiffness and exponent as they are set", "line contact, from geometry"),
)


STEEPEST = 3.0  # exponent of the power law, at most
WIDEST = 0.35  # half the strip over the journal's radius, 20 degrees: wider, bodies are not half-planes


@dataclass(frozen=True)
class BoreContact(ContactLaw):
    """Contact of journal and bore: constants of the law, and the parts from which a line contact's follow.

    Defaults: steel on steel, the inner ring of a 6904.
    """

    law: int = choice(AS_SET, LAWS, "where stiffness and exponent come from")
    length: float = real(
        9e-3,
        "m",
        "length along which journal and bore touch, of a line contact",
        above=0.0,
        needs="law == 1 or ?ring.harmonics",
    )
    depth: float = real(
        1.29e-3,
        "m",
        "from the bore to the centroid of the ring's section, of a line contact",
        above=0.0,
        needs="law == 1",
    )
    load: float = real(
        400.0,
        "N",
        "at which a line contact's power law has its force and slope",
        above=0.0,
        needs="law == 1",
    )
    modulus: float = real(
        207e9, "Pa", "modulus of elasticity of the bore, of a line contact", above=0.0, needs="law == 1"
    )
    poisson: float = real(
        0.3,
        "1",
        "Poisson's ratio of the bore, of a line contact",
        minimum=0.0,
        maximum=0.5,
        needs="law == 1",
    )
    journal_modulus: float = real(
        207e9, "Pa", "modulus of elasticity of the journal, of a line contact", above=0.0, needs="law == 1"
    )
    journal_poisson: float = real(
        0.3,
        "1",
        "Poisson's ratio of the journal, of a line contact",
        minimum=0.0,
        maximum=0.5,
        needs="law == 1",
    )
    tilt: float = real(
        0.0,
        "rad",
        "of the journal in its bore, which softens a line contact; constant, on top of what a land feels",
        minimum=0.0,
        maximum=0.1,
        needs="law == 1",
    )


class Approach(NamedTuple):
    """How far a line contact gives way under its load."""

    indentation: float  # m
    slope: float  # m/N, its derivative by the load
    half_width: float  # m, of the strip


@kernel
def half_width(press, law, journal_radius, clearance):
    """Of the strip (m) under `press` (N/m); the others as of `bore_approach`."""
    curvature = clearance / (journal_radius * (journal_radius + clearance))
    of_journal = (1.0 - squared(law.journal_poisson)) / law.journal_modulus
    of_bore = (1.0 - squared(law.poisson)) / law.modulus
    return math.sqrt(4.0 * press * (of_journal + of_bore) / (math.pi * curvature))


@kernel
def bore_approach(load, law, journal_radius, clearance):
    """`Approach` of a journal of `journal_radius` in a bore wider by `clearance` (m), under `load` (N).

    law: a record of `BoreContact`.
    """
    press = load / law.length
    of_journal = (1.0 - squared(law.journal_poisson)) / law.journal_modulus
    width = half_width(press, law, journal_radius, clearance)
    journal = of_journal / math.pi * (2.0 * math.log(4.0 * journal_radius / width) - 1.0)
    # b grows with the root of the load: both logarithms fall by one half of its relative change
    falls, ring = of_journal / math.pi, 2.0 * math.log(2.0 * law.depth / width) - law.poisson
    if ring > 1.0:
        ring /= math.pi * law.modulus
        falls += 1.0 / (math.pi * law.modulus)
    else:  # its approach stays at its maximum; ring counts per load, and falls with it
        widest = 2.0 * law.depth * math.exp(-0.5 * (1.0 + law.poisson))
        ring = squared(widest / width) / (math.pi * law.modulus)
        falls += ring
    return Approach(press * (journal + ring), (journal + ring - falls) / law.length, width)


STRAIGHT = 1e-6  # way of an edge over the indentation, below which a journal is not tilted
NEWTON_STEPS = 60  # from above on a convex curve: each comes nearer


@kernel
def tilted(straight, load, law):
    """`Approach` (m, m/N, m) at the edge that a journal tilted by law.tilt touches first, under `load` (N).

    straight: its `Approach` without a tilt, under that load.
    """
    across = law.tilt * law.length
    if across < STRAIGHT * straight.indentation:
        return straight
    power = straight.indentation / (load * straight.slope) + 1.0
    each = load / straight.indentation ** (power - 1.0) / (across * power)
    depth = (load / each) ** (1.0 / power)
    if depth <= across:  # on a part of the length
        return Approach(depth, depth / (load * power), straight.half_width)
    depth, steep = straight.indentation + across, 0.0
    for _ in range(NEWTON_STEPS):
        steep = each * power * (depth ** (power - 1.0) - (depth - across) ** (power - 1.0))
        depth -= (each * (depth**power - (depth - across) ** power) - load) / steep
    return Approach(depth, 1.0 / steep, straight.half_width)


@kernel
def is_narrow(law, journal_radius, clearance):
    """Whether bodies are half-planes beside the strip of a `BoreContact` at its load."""
    return bore_approach(law.load, law, journal_radius, clearance).half_width < WIDEST * journal_radius


@kernel
def is_line(law, journal_radius, clearance):
    """Whether a `BoreContact` makes a line contact at its load, and no bearing of half a bore."""
    found = bore_approach(law.load, law, journal_radius, clearance)
    narrow = is_narrow(law, journal_radius, clearance)
    return narrow and found.indentation < STEEPEST * law.load * found.slope


@kernel
def set_line(law, journal_radius, clearance):
    """Set stiffness, exponent and expected indentation of `law`, a record, to those of its line contact."""
    found = tilted(bore_approach(law.load, law, journal_radius, clearance), law.load, law)
    law.exponent = found.indentation / (law.load * found.slope)
    law.stiffness = law.load / found.indentation**law.exponent
    law.expected_indentation = found.indentation


class Depths(NamedTuple):
    """How deep (m) a force presses a journal into its bore, by three laws."""

    by_power: float  # stiffness and exponent as set
    by_line: float  # a line contact, tilted as set
    by_tilted: float  # a line contact, tilted by `EXAMPLE_TILT`


EXAMPLE_TILT = 1e-3  # rad


def indentations(contact: BoreContact, journal_radius: float, clearance: float, force: float) -> Depths:
    """`Depths` of a journal under `force` (N, above 0); journal_radius, clearance: m."""
    by_power = (force / contact.stiffness) ** (1.0 / contact.exponent)
    straight = bore_approach(force, as_record(contact), journal_radius, clearance)
    by_line, by_tilted = (
        float(tilted(straight, force, as_record(replace(contact, tilt=tilt))).indentation)
        for tilt in (contact.tilt, EXAMPLE_TILT)
    )
    return Depths(by_power, by_line, by_tilted)
