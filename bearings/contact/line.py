"""How stiff a journal lies in its bore, from geometry: a line contact of two cylinders.

The source gives the contact a stiffness and an exponent (2.12) that are not from its parts. A cylinder that
lies along a length L in a bore of nearly its radius touches in a strip of half the width b, under P/L a
metre (Hertz; Johnson, Contact Mechanics, sections 4.2 and 5.6):

    q = P/L    1/R = 1/R_j - 1/(R_j + c)    1/E* = (1 - nu_j^2)/E_j + (1 - nu_r^2)/E_r
    b^2 = 4 q R/(pi E*)

The approach of two bodies in line contact hangs on how deep they are. The journal is a cylinder in plane
strain, whose axis comes nearer to the strip (Johnson 5.57); of the ring counts what lies between strip and
the centroids of its sections, `depth` away, in plane stress; what bends beyond is the ring's own:

    approach = q (1 - nu_j^2)/(pi E_j) (2 ln(4 R_j/b) - 1) + q/(pi E_r) (2 ln(2 depth/b) - nu_r)

Kernels take the power law k d^n that has this force and this slope at a design load, and no logarithm at
every step. With n = 1.2, as of a 6904 at 400 N, it errs by 1 % from half to twice that load and by 6 % at
an eighth of it; near n = 1.5, of heavy rotors and small clearances, by 4 % at twice and 10 % at eight times
the load, always with too little force.

The last term has a maximum, where its bracket is 1; beyond, where the formula does not hold, the ring's
approach stays at that. The journal is taken to lie in the bore along its whole length; tilted, it touches
on a part of that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.variables import Choices, as_record, choice, real
from .laws import ContactLaw

AS_SET, FROM_GEOMETRY = range(2)
LAWS = Choices(
    "ContactStiffness",
    ("power", "line"),
    ("stiffness and exponent as they are set", "line contact, from geometry"),
)


STEEPEST = 3.0  # exponent of the power law, at most
WIDEST = 0.35  # half the strip over the journal's radius, 20 degrees: wider, bodies are no half-planes


@dataclass(frozen=True)
class BoreContact(ContactLaw):
    """Contact of journal and bore: constants of the law, and the parts from which a line contact's follow.

    Defaults: steel on steel, the inner ring of a 6904.
    """

    law: int = choice(AS_SET, LAWS, "where stiffness and exponent come from")
    length: float = real(
        9e-3, "m", "length along which journal and bore touch, of a line contact", above=0.0
    )
    depth: float = real(
        1.29e-3, "m", "from the bore to the centroid of the ring's section, of a line contact", above=0.0
    )
    load: float = real(400.0, "N", "at which a line contact's power law has its force and slope", above=0.0)
    modulus: float = real(207e9, "Pa", "modulus of elasticity of the bore, of a line contact", above=0.0)
    poisson: float = real(
        0.3, "1", "Poisson's ratio of the bore, of a line contact", minimum=0.0, maximum=0.5
    )
    journal_modulus: float = real(
        207e9, "Pa", "modulus of elasticity of the journal, of a line contact", above=0.0
    )
    journal_poisson: float = real(
        0.3, "1", "Poisson's ratio of the journal, of a line contact", minimum=0.0, maximum=0.5
    )


class Approach(NamedTuple):
    """How far a line contact gives way under its load."""

    indentation: float  # m
    slope: float  # m/N, its derivative by the load
    half_width: float  # m, of the strip


@kernel
def approach(load, law, journal_radius, clearance):
    """`Approach` of a journal of `journal_radius` in a bore wider by `clearance` (m), under `load` (N).

    law: a record of `BoreContact`.
    """
    press = load / law.length
    curvature = clearance / (journal_radius * (journal_radius + clearance))
    of_journal = (1.0 - law.journal_poisson**2.0) / law.journal_modulus
    of_bore = (1.0 - law.poisson**2.0) / law.modulus
    width = math.sqrt(4.0 * press * (of_journal + of_bore) / (math.pi * curvature))
    journal = of_journal / math.pi * (2.0 * math.log(4.0 * journal_radius / width) - 1.0)
    # b grows with the root of the load: both logarithms fall by one half of its relative change
    falls, ring = of_journal / math.pi, 2.0 * math.log(2.0 * law.depth / width) - law.poisson
    if ring > 1.0:
        ring /= math.pi * law.modulus
        falls += 1.0 / (math.pi * law.modulus)
    else:  # its approach stays at its maximum; ring counts per load, and falls with it
        widest = 2.0 * law.depth * math.exp(-0.5 * (1.0 + law.poisson))
        ring = (widest / width) ** 2.0 / (math.pi * law.modulus)
        falls += ring
    return Approach(press * (journal + ring), (journal + ring - falls) / law.length, width)


@kernel
def is_narrow(law, journal_radius, clearance):
    """Whether bodies are half-planes beside the strip of a `BoreContact` at its load."""
    return approach(law.load, law, journal_radius, clearance).half_width < WIDEST * journal_radius


@kernel
def is_line(law, journal_radius, clearance):
    """Whether a `BoreContact` makes a line contact at its load, and no bearing of half a bore."""
    found = approach(law.load, law, journal_radius, clearance)
    narrow = is_narrow(law, journal_radius, clearance)
    return narrow and found.indentation < STEEPEST * law.load * found.slope


@kernel
def set_line(law, journal_radius, clearance):
    """Set stiffness, exponent and expected indentation of `law`, a record, to those of its line contact."""
    found = approach(law.load, law, journal_radius, clearance)
    law.exponent = found.indentation / (law.load * found.slope)
    law.stiffness = law.load / found.indentation**law.exponent
    law.expected_indentation = found.indentation


def indentations(
    contact: BoreContact, journal_radius: float, clearance: float, force: float
) -> tuple[float, float]:
    """How deep (m) `force` (N) presses a journal by stiffness and exponent as set, and as a line contact.

    journal_radius, clearance: m.
    """
    by_power = (force / contact.stiffness) ** (1.0 / contact.exponent)
    by_line = (
        approach(force, as_record(contact), journal_radius, clearance).indentation if force > 0.0 else 0.0
    )
    return by_power, float(by_line)
