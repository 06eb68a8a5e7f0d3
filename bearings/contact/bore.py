"""The journal and its bore as parameters have them: what may be wrong, and the laws between them."""

from __future__ import annotations

from touchdown.bearings.contact import friction, proportion
from touchdown.bearings.contact.laws import damp
from touchdown.bearings.contact.proportion import out_of_proportion
from touchdown.modelkit.kernel import kernel

_LENGTHS = (
    proportion.problem("clearance", "journal_radius"),
    proportion.problem("contact.expected_indentation", "journal_radius"),
)
PROBLEMS = (*_LENGTHS, *friction.problems("friction"))


@kernel
def problem(p, usual, told):
    """What is wrong with the journal and its bore: its number in `PROBLEMS`, or 0.

    p: a bearing's parameters; usual: static coefficient of friction by default; told: `Model`'s m.told.
    """
    found = 0
    if out_of_proportion(p.clearance, p.journal_radius, told):
        found = 1
    elif out_of_proportion(p.contact.expected_indentation, p.journal_radius, told):
        found = 2
    else:
        found = friction.problem(p.friction, usual, told)
        found = found + 2 if found != 0 else 0
    return found


@kernel
def settle(d, p, lighter):
    """Set the laws d.contact and d.friction by those in p; lighter: mass of the lighter body (kg)."""
    d.contact = p.contact
    damp(d.contact, lighter)
    d.friction = p.friction
    friction.settle(d.friction)
