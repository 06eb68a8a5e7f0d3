"""Normal contact forces.

One law holds the source's three: Hertz (2.1), indentation-proportional damping (2.38) and the
rotor-ring law (2.12) with its exponent and dissipation parameter; (2.2), plain linear damping, is the
`viscous` term.

    f = k d^n (1 + eps d') + c d d' + v d'        for d > 0, never below zero

A passive contact does not pull: where damping would make f negative the contact has parted. The source
does not say so; the force cut off is below 0.1 um of indentation in its cases.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from touchdown.bearings.contact.stiffness import damping_from_ratio
from touchdown.modelkit.kernel import kernel, woven
from touchdown.modelkit.variables import real


@dataclass(frozen=True)
class ContactLaw:
    """Constants of a normal contact. `stiffness` carries the unit N/m^exponent."""

    stiffness: float = real(2.4e9, "N/m^n", "contact stiffness k (n is the exponent)", above=0.0)
    exponent: float = real(1.5, "1", "exponent n of the indentation", minimum=1.0, maximum=3.0)
    damping: float = real(0.0, "N.s/m2", "damping c proportional to indentation (2.38)", minimum=0.0)
    dissipation: float = real(0.0, "s/m", "dissipation parameter epsilon (2.12)", minimum=0.0)
    viscous: float = real(0.0, "N.s/m", "linear damping while in contact (2.2)", minimum=0.0)
    damping_ratio: float = real(
        0.0, "1", "damping ratio (2.47) of the contact, added to `damping`", minimum=0.0
    )
    expected_indentation: float = real(
        1e-5, "m", "peak indentation for which the damping ratio holds", above=0.0
    )
    mass: float = real(
        0.0, "kg", "mass for which the damping ratio holds; 0: the lighter body's", minimum=0.0
    )


@kernel
def damp(law, lighter):
    """Add to `law`, a record, the damping that its ratio asks for (2.47).

    lighter: mass of the lighter body (kg).
    """
    if law.damping_ratio == 0.0:
        return
    depth, mass = law.expected_indentation, law.mass if law.mass != 0.0 else lighter
    slope = law.exponent * law.stiffness * depth ** (law.exponent - 1.0)
    law.damping += damping_from_ratio(slope, mass, law.damping_ratio, depth)
    law.damping_ratio = 0.0


@kernel
def lay_abreast(law, rows):
    """Make `law`, a record, that of `rows` like contacts side by side, that share the load."""
    law.stiffness *= rows
    law.damping *= rows
    law.viscous *= rows
    law.mass *= rows


@kernel
def power(x, exponent):
    """x^exponent for a number x > 0; the Hertz exponent takes the short way."""
    if exponent == 1.5:
        return x * math.sqrt(x)
    return x**exponent


@woven
def hertz(indentation, stiffness, damping):
    """(Elastic force (N), damping (N s/m), stiffness at this load (N/m)) of (2.1) and (2.38), zero apart.

    indentation: m; stiffness: N/m^1.5; damping: N s/m2.
    """
    depth = max(indentation, 0.0)
    root = math.sqrt(depth)
    return stiffness * depth * root, damping * depth, 1.5 * stiffness * root


@kernel
def elastic_force(indentation, law):
    """k d^n (N) at an indentation d (m), zero where bodies are apart (2.1); law: a record."""
    if indentation <= 0.0:
        return 0.0
    return law.stiffness * power(indentation, law.exponent)


@kernel
def elastic_energy(indentation, law):
    """Energy stored in the contact (J) at an indentation d (m): k d^(n+1) / (n+1); law: a record."""
    return elastic_force(indentation, law) * max(indentation, 0.0) / (law.exponent + 1.0)


@kernel
def elastic_and_damping(indentation, law):
    """(Elastic force (N), damping (N s/m)) at an `indentation` (m), zero where bodies are apart."""
    if indentation <= 0.0:
        return 0.0, 0.0
    elastic = law.stiffness * power(indentation, law.exponent)
    return elastic, law.dissipation * elastic + law.damping * indentation + law.viscous


@kernel
def normal_force(indentation, rate, law):
    """Force pressing the bodies apart (N) at an `indentation` (m) of `rate` (m/s); law: a record."""
    elastic, damping = elastic_and_damping(indentation, law)
    return max(elastic + damping * rate, 0.0)
