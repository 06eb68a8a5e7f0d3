"""Normal contact: what every law must keep to. `touchdown validate` has impacts against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from contact_law import normal_force, stated_force

from touchdown.bearings.contact.laws import ContactLaw, elastic_energy, elastic_force
from touchdown.modelkit.variables import as_record

STIFFNESS = 2.4e9
ROUNDING = 1e-15

LAWS = {
    "Hertz (2.1)": ContactLaw(),
    "indentation-proportional (2.38)": ContactLaw(damping=1e7),
    "rotor-ring (2.12)": ContactLaw(exponent=10 / 9, dissipation=0.12),
    "linear damping (2.2)": ContactLaw(viscous=150.0),
    "all terms, n = 2.5": ContactLaw(exponent=2.5, damping=3e6, dissipation=0.4, viscous=20.0),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


@every_law
def test_no_force_inside_the_gap(law):
    """Bodies apart, or only just touching, leave each other alone; a little deeper they do not."""
    record = as_record(law)
    for indentation in (-1e-3, -1e-9, -0.0, 0.0):
        assert normal_force(indentation, -1.0, record) == normal_force(indentation, 1.0, record) == 0.0
        assert elastic_force(indentation, record) == 0.0
        assert elastic_energy(indentation, record) == 0.0
    assert normal_force(1e-6, 0.0, record) > 0.0


@every_law
def test_no_adhesion(law):
    """However fast bodies part, the force does not pull; approaching, damping only adds, rounding apart."""
    record = as_record(law)
    for indentation in np.geomspace(1e-10, 1e-4, 25):
        elastic = elastic_force(indentation, record)
        assert elastic > 0.0
        for speed in np.geomspace(1e-4, 1e3, 29):
            assert 0.0 <= normal_force(indentation, -speed, record) <= elastic * (1.0 + ROUNDING)
            assert normal_force(indentation, speed, record) >= elastic * (1.0 - ROUNDING)


@every_law
@pytest.mark.parametrize("indentation", [1e-7, 8e-5])
def test_force_is_the_slope_of_the_energy(law, indentation):
    """d/dd of the stored energy is the elastic force, and that is the force at rest."""
    record = as_record(law)
    step = 1e-4 * indentation
    rise = elastic_energy(indentation + step, record) - elastic_energy(indentation - step, record)
    force = elastic_force(indentation, record)
    assert force == pytest.approx(rise / (2.0 * step), rel=1e-7)
    assert force == pytest.approx(law.stiffness * indentation**law.exponent, rel=1e-14)
    assert normal_force(indentation, 0.0, record) == pytest.approx(force, rel=ROUNDING)


def test_terms_of_the_law_add_up():
    """Each damping constant acts alone as its equation says."""
    d, v = 7e-6, 0.04
    elastic = STIFFNESS * d**1.5
    terms = {"damping": (1e7, 1e7 * d), "dissipation": (0.12, 0.12 * elastic), "viscous": (150.0, 150.0)}
    for name, (constant, per_speed) in terms.items():
        record = as_record(ContactLaw(**{name: constant}))
        assert normal_force(d, v, record) - elastic == pytest.approx(per_speed * v, rel=1e-9)
        assert normal_force(d, v, record) == pytest.approx(stated_force(d, v, record), rel=1e-14)
