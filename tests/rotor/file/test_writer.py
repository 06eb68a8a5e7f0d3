"""Shafts written as rotor files: what is read from them is the same to the bit."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.beam_body import PointMass, disc_mass
from touchdown.rotor.beams.element import Element, split_element
from touchdown.rotor.beams.shaft import Gap, Shaft, Station, Support, Unbalance
from touchdown.rotor.file import load_rotor, parse_rotor, rotor_text, save_rotor, shipped_rotors

STEEL = Element(length=0.02, outer_diameter=0.03, modulus=207e9, density=7830.0, poisson=0.3)
BRONZE = dataclasses.replace(STEEL, modulus=110e9, density=8800.0, poisson=-0.2)
LAYERED = dataclasses.replace(  # a cone with a tube on it, and a solid bar beside
    STEEL,
    outer_diameter_end=0.04,
    inner_diameter_end=0.01,
    layers=(
        dataclasses.replace(BRONZE, inner_diameter=0.03, inner_diameter_end=0.04, outer_diameter=0.05),
        dataclasses.replace(BRONZE, outer_diameter=0.07, shear_factor=0.8),
    ),
)
HAND_MADE = Shaft(
    title='A "stub"\tshaft \x7f',
    about='Two lines, a \\ and """,\nmade by hand: 10 µm',
    elements=(
        STEEL,
        STEEL,
        dataclasses.replace(STEEL, length=1.0 / 30.0, inner_diameter=0.0051, shear_factor=0.85),
        dataclasses.replace(STEEL, sleeve_diameter=0.055, sleeve_density=7650.0, sleeve_modulus=42.2e9),
        dataclasses.replace(STEEL, sleeve_diameter=0.056, sleeve_density=7650.0),
        dataclasses.replace(STEEL, modulus=110e9, density=4430.0, poisson=0.34, length=np.float64(0.1)),
        *split_element(LAYERED, 3),
    ),
    points=(disc_mass(3, 0.08, 0.03, 0.01, 7830.0), PointMass(1, 0.1), PointMass(7, 0.0, 1e-4, 0.7e-4)),
    unbalances=(Unbalance(3, 3e-6, -math.pi / 2.0), Unbalance(3, 1e-6 / 7.0, 1.0)),
    stations=(Station("B", 6), Station("A", 2), Station("amb", 4)),
    sensors=(Station("beside", 4),),
    levitated_at=("amb",),
    damping_ratio=0.0042,
    supports=(Support(2, 1e7), Support(6, 1.0 / 3.0, 2e6, 0.0, 500.0)),
)
BARE = Shaft("Bare", (STEEL,))
SHAFTS = {
    **{name: load_rotor(path) for name, path in shipped_rotors().items()},
    "hand-made": HAND_MADE,
    "bare": BARE,
}
assert {"rotor_I", "rotor_II"} < set(SHAFTS)


@pytest.mark.parametrize("name", SHAFTS)
def test_what_is_saved_is_loaded_again(name: str, tmp_path: Path) -> None:
    """Equal, and written alike once more: to the bit, since each number is a part of both."""
    path = tmp_path / "rotor.toml"
    save_rotor(SHAFTS[name], path)
    again = load_rotor(path)
    assert again == SHAFTS[name]
    assert rotor_text(again) == path.read_text(encoding="utf-8")


def test_numbers_of_any_bits_are_read_again() -> None:
    for x in np.random.default_rng(1).uniform(0.5, 1.5, 200):
        element = dataclasses.replace(
            STEEL, length=0.02 * x, outer_diameter=0.03 * x, modulus=207e9 * x, density=7830.0 * x
        )
        shaft = Shaft(
            "Any", (element,), (PointMass(1, x, 1e-3 * x, 1e-3 / x),), (Unbalance(2, 1e-6 * x, x),)
        )
        assert parse_rotor(rotor_text(shaft), "any") == shaft


def test_gaps_are_read_again() -> None:
    """At a station, where they may act, and at a sensor."""
    places = {"stations": (Station("A", 1),), "sensors": (Station("eye", 2),)}
    gaps = Gap("seal", "A", 1e-4, 0.02), Gap("magnet", "eye", 3e-4)
    shaft = Shaft("S", (STEEL,), gaps=gaps, **places)
    assert parse_rotor(rotor_text(shaft), "any") == shaft


@pytest.mark.parametrize(
    ("shaft", "says"),
    [
        (
            Shaft("S", (dataclasses.replace(STEEL, length=-0.02),)),
            r"element\[1\].length = '-20 mm' must be",
        ),
        (
            Shaft("S", (STEEL,), stations=(Station("A", 1),), gaps=(Gap("seal", "B", 1e-4),)),
            r"gap\[1\].station = 'B' is not a station or sensor; there are: A",
        ),
        (Shaft("S", ()), "element is missing"),
        (
            Shaft("S", (dataclasses.replace(STEEL, sleeve_density=1e3),)),
            "would be read as another one; look for a sleeve's density",
        ),
    ],
)
def test_what_no_rotor_file_can_say_is_named(shaft: Shaft, says: str, tmp_path: Path) -> None:
    path = tmp_path / "rotor.toml"
    with pytest.raises(TouchdownError, match=says):
        save_rotor(shaft, path)
    assert not path.exists()
