"""How long steps inside the bearings may be, and what counts as stiffness for them."""

from __future__ import annotations

import pytest

from touchdown.bearings.contact.laws import ContactLaw
from touchdown.bearings.contact.pair import NO_KICK, Place
from touchdown.bearings.rolling.micro_step import MICRO_STEP, RESOLUTION, refined, step_in_hit
from touchdown.bearings.rolling.sides import SideContacts, lay
from touchdown.fmus.recipes import recipe
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.variables import as_record

SOFT, STIFF = (ContactLaw(stiffness=1e6), 1.0), (ContactLaw(stiffness=1e13), 1e-4)


@pytest.mark.parametrize("contact", [SOFT, STIFF])  # of which none, and one, shortens the step
def test_a_finer_step_refines_all_of_them(contact: tuple[ContactLaw, float]) -> None:
    law, mass = as_record(contact[0]), contact[1]
    whole, half = step_in_hit(MICRO_STEP, law, mass), step_in_hit(0.5 * MICRO_STEP, law, mass)
    assert (whole < MICRO_STEP) == (contact is STIFF)
    assert half == pytest.approx(0.5 * whole, rel=1e-12)
    assert (refined(MICRO_STEP), refined(0.5 * MICRO_STEP)) == (1.0, 0.5)


def test_a_longer_step_resolves_contacts_as_well() -> None:
    law, mass = as_record(STIFF[0]), STIFF[1]
    assert step_in_hit(4.0 * MICRO_STEP, law, mass) == step_in_hit(MICRO_STEP, law, mass)
    assert refined(4.0 * MICRO_STEP) == 1.0


@pytest.mark.parametrize("name", ["simplified_cageless", "detailed_caged", "detailed_cageless"])
def test_the_stiffest_contact_decides(name: str) -> None:
    """Soft ones leave the step that is asked for."""
    for stiffness, shorter in ((2e9, False), (1e16, True)):
        instance = Instance(recipe(name).model)
        instance.record["p"]["contact"]["stiffness"] = stiffness
        instance.start(0.0)
        assert (instance.record["d"]["micro_step"] < MICRO_STEP) == shorter
        assert instance.record["d"]["resolution"] == RESOLUTION


def test_damping_is_no_stiffness() -> None:
    """A dashpot pushes at once where bodies meet, over no indentation: no step could resolve that."""
    law = as_record(ContactLaw(exponent=1.5, stiffness=1e8, viscous=250.0))
    contacts = as_record(SideContacts())
    lay(contacts, 3, Place(1.0, 0.0, 1e-9, 1e-3, 1e-3, 0.0), 0.0, 0.1, NO_KICK, law)
    assert contacts["stiffness"][3] == pytest.approx(1.5 * 1e8 * 1e-9**1.5 / 1e-9, rel=1e-6)
