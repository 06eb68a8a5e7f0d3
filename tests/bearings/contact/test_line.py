"""The journal in its bore as a line contact: closed forms, finite elements, the law that kernels take."""

from __future__ import annotations

from dataclasses import replace

import pytest
from scipy.integrate import quad

import touchdown
from touchdown.bearings import catalogue
from touchdown.bearings.catalogue.landing import landing
from touchdown.bearings.contact.line import (
    FROM_GEOMETRY,
    Approach,
    BoreContact,
    bore_approach,
    set_line,
    tilted,
)
from touchdown.bearings.contact.materials import STEEL_NUMBERS
from touchdown.bearings.rolling.ball_set import RaceStiffness, set_stiffness
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.modelkit.variables import as_record

RADIUS, CLEARANCE = 9.7e-3, 0.3e-3  # m, of the disk's journal
BORES = {name: catalogue.bearing(name) for name in ("6904", "6004")}


def law(name: str, load: float = 400.0) -> BoreContact:
    """Of a bearing's bore, steel on steel."""
    return BoreContact(length=BORES[name].width, depth=BORES[name].depth, load=load, law=FROM_GEOMETRY)


@pytest.mark.parametrize(
    ("name", "load", "indentation", "half_width"),
    [
        # 2-D finite elements of the ring, its bending taken off; m
        ("6904", 100.0, 0.221e-6, 0.20e-3),
        ("6904", 350.0, 0.646e-6, 0.40e-3),
        ("6904", 800.0, 1.287e-6, 0.60e-3),
        ("6004", 350.0, 0.561e-6, 0.32e-3),
        ("6004", 800.0, 1.133e-6, 0.50e-3),
    ],
)
def test_it_gives_way_as_finite_elements_do(
    name: str, load: float, indentation: float, half_width: float
) -> None:
    """Within 6 % in the approach; the strip's width is known to an element of 0.06 mm."""
    found = bore_approach(load, as_record(law(name)), RADIUS, CLEARANCE)
    assert found.indentation == pytest.approx(indentation, rel=0.06)
    assert found.half_width == pytest.approx(half_width, abs=0.06e-3)


@pytest.mark.parametrize(
    ("name", "stiffness", "exponent"), [("6904", 1.111e10, 1.2141), ("6004", 1.028e10, 1.1920)]
)
def test_the_power_law_touches_it_at_its_load(name: str, stiffness: float, exponent: float) -> None:
    """With the digits of another program; 1 % off at half and at twice the load, 6 at an eighth."""
    record = as_record(law(name))
    set_line(record, RADIUS, CLEARANCE)
    k, n = float(record["stiffness"]), float(record["exponent"])
    assert (k, n) == (pytest.approx(stiffness, rel=1e-3), pytest.approx(exponent, rel=1e-4))
    for load, error in ((400.0, 1e-12), (200.0, 0.01), (800.0, 0.01), (50.0, 0.07)):
        indentation = bore_approach(load, record, RADIUS, CLEARANCE).indentation
        assert k * indentation**n == pytest.approx(load, rel=error)


@pytest.mark.parametrize(
    ("name", "tilt", "slope", "edge"),
    [
        # slices by quadrature, of another program: rad, N/m, m
        ("6904", 0.0, 7.33e8, 1.24e-6),
        ("6904", 1e-4, 7.30e8, 1.69e-6),
        ("6904", 3e-4, 6.58e8, 2.53e-6),
        ("6904", 1e-3, 3.82e8, 4.35e-6),
        ("6904", 3e-3, 2.33e8, 7.14e-6),
        ("6004", 1e-4, 8.58e8, 1.62e-6),
        ("6004", 3e-3, 2.21e8, 7.45e-6),
    ],
)
def test_a_tilt_softens_the_bore(name: str, tilt: float, slope: float, edge: float) -> None:
    """At 750 N by the straight line's power law of 400 N, as that program has it; to its three digits."""
    known = as_record(law(name))
    set_line(known, RADIUS, CLEARANCE)
    power = float(known["exponent"])
    depth = (750.0 / float(known["stiffness"])) ** (1.0 / power)
    record = as_record(replace(law(name), tilt=tilt))
    found = tilted(Approach(depth, depth / (750.0 * power), 0.0), 750.0, record)
    assert 1.0 / found.slope == pytest.approx(slope, rel=5e-3)
    assert found.indentation == pytest.approx(edge, rel=5e-3)
    straight = bore_approach(400.0, record, RADIUS, CLEARANCE)
    set_line(record, RADIUS, CLEARANCE)
    found = tilted(straight, 400.0, record)
    assert float(record["expected_indentation"]) == pytest.approx(found.indentation, rel=1e-12)
    assert float(record["exponent"]) == pytest.approx(found.indentation / (400.0 * found.slope), rel=1e-12)


@pytest.mark.parametrize(
    ("scene", "model", "stiffness"),
    [
        ("disk-caged-simplified", "simplified_caged", 1.028e10),
        ("disk-caged-simplified", "bushing", 1.028e10),
        ("disk-cageless-detailed", "bushing", 1.111e10),
        ("disk-cageless-detailed", "detailed_cageless", 1.111e10),
    ],
)
def test_a_bearing_s_bore_is_that_of_its_balls(scene: str, model: str, stiffness: float) -> None:
    """A 6004's or a 6904's, as the scene has it, which a swap keeps."""
    swapped = touchdown.load(scene).swap(bearing=model)
    with opened(swapped.set({"bearing.contact.law": "line"}), in_process=True) as system:
        system.initialise()
        known = system.components["bearing"].instance.record["d"]["contact"]  # type: ignore[attr-defined]
    assert float(known["stiffness"]) == pytest.approx(stiffness, rel=3e-3)
    with opened(touchdown.load("rotor2-case1"), in_process=True) as system:
        assert system.value("bearing_A.contact.length") == 20e-3  # of the 6014


def test_a_line_that_would_be_wider_than_its_parts_is_refused() -> None:
    scene = touchdown.load("disk-caged-simplified").set({"bearing.contact.law": "line"})
    with (
        pytest.raises(TouchdownError, match=r"contact.load = 1e\+06 N makes no line contact"),
        opened(scene.set({"bearing.contact.load": 1e6}), in_process=True) as system,
    ):
        system.initialise()


def test_the_landing_s_energy_is_in_bore_and_balls() -> None:
    """Work of the load found, by quadrature: the disk's fall through its clearance."""
    energy, one = 1.65 * 9.81 * CLEARANCE, BORES["6904"]
    load = landing(one, CLEARANCE, energy).load
    record = as_record(law("6904"))
    bore, _ = quad(lambda p: p * bore_approach(p, record, RADIUS, CLEARANCE).slope, 1e-3, load)
    stiffness = as_record(RaceStiffness())
    set_stiffness(stiffness, as_record(one.balls), STEEL_NUMBERS)
    indentation = (4.37 / 17.0 * load / float(stiffness["series"])) ** (2.0 / 3.0)
    assert bore + 0.4 * load * indentation == pytest.approx(energy, rel=0.01)
    assert 868.0 < load < 1.2 * 868.0  # N, of the detailed model's first impact, which has a housing, too
