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

from modelkit.kernel import kernel, woven
from modelkit.variables import real


@dataclass(frozen=True)
class ContactLaw:
    """Constants of a normal contact. `stiffness` carries the unit N/m^exponent."""

    stiffness: float = real(2.4e9, "N/m^n", "contact stiffness k (n is the exponent)", above=0.0)
    exponent: float = real(1.5, "1", "exponent n of the indentation", minimum=1.0, maximum=3.0)
    damping: float = real(0.0, "N.s/m2", "damping c proportional to indentation (2.38)", minimum=0.0)
    dissipation: float = real(0.0, "s/m", "dissipation parameter epsilon (2.12)", minimum=0.0)
    viscous: float = real(0.0, "N.s/m", "linear damping while in contact (2.2)", minimum=0.0)


@kernel
def power(x, exponent):
    """x^exponent for x > 0; the Hertz exponent takes the short way."""
    if exponent == 1.5:
        return x * math.sqrt(x)
    return x**exponent


@woven
def hertz(indentation, rate, stiffness, damping):
    """(Normal force, its elastic part, stiffness at this load in N/m) of (2.1) and (2.38), zero apart."""
    depth = max(indentation, 0.0)
    root = math.sqrt(depth)
    elastic = stiffness * depth * root
    return max(elastic + damping * depth * rate, 0.0), elastic, 1.5 * stiffness * root


@kernel
def elastic_force(indentation, law):
    """k d^n (N), zero where bodies are apart (2.1)."""
    if indentation <= 0.0:
        return 0.0
    return law.stiffness * power(indentation, law.exponent)


@kernel
def elastic_energy(indentation, law):
    """Energy stored in the contact (J): k d^(n+1) / (n+1)."""
    return elastic_force(indentation, law) * max(indentation, 0.0) / (law.exponent + 1.0)


@kernel
def normal_and_elastic(indentation, rate, law):
    """(Force pressing the bodies apart, its elastic part) in N; `rate` is the indentation's (m/s)."""
    if indentation <= 0.0:
        return 0.0, 0.0
    elastic = law.stiffness * power(indentation, law.exponent)
    damping = law.dissipation * elastic + law.damping * indentation + law.viscous
    return max(elastic + damping * rate, 0.0), elastic


@kernel
def normal_force(indentation, rate, law):
    """Force pressing the bodies apart (N); `rate` is the indentation's time derivative (m/s)."""
    return normal_and_elastic(indentation, rate, law)[0]
