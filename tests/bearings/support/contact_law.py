"""The normal force of a contact: as the models make it at an instant, and as its equation says."""

from __future__ import annotations

from typing import Any

from touchdown.bearings.contact.laws import elastic_and_damping
from touchdown.bearings.contact.pair import damped_normal


def normal_force(indentation: float, rate: float, law: Any) -> float:
    """By the kernels (N), outside of a kick; law: a record."""
    elastic, damping = elastic_and_damping(indentation, law)
    return damped_normal(elastic, damping, rate, 0.0, 0.0)


def stated_force(indentation: float, rate: float, law: Any) -> float:
    """k d^n (1 + eps d') + c d d' + v d' (N) of bodies that touch, never below zero; law: a record."""
    if indentation <= 0.0:
        return 0.0
    names = ("stiffness", "exponent", "dissipation", "damping", "viscous")
    k, n, epsilon, c, v = (float(law[name]) for name in names)
    elastic = k * indentation**n
    return max(elastic * (1.0 + epsilon * rate) + (c * indentation + v) * rate, 0.0)
