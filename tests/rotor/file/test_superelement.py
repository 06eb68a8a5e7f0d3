"""[superelement] in a rotor's file: what it may hold, and each mistake in one line."""

from __future__ import annotations

import numpy as np
import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.beams.superelement import Superelement, symmetric_body
from touchdown.rotor.file import parse_rotor, rotor_named, rotor_text
from touchdown.rotor.flexible import flexible_rotor
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.properties import rotor_properties
from touchdown.rotor.static_deflection import at_rest

SPINDLE = rotor_named("rotor_I")


def by_matrices() -> Shaft:
    """Rotor I, known by its matrices."""
    own = SPINDLE.body.matrices()
    body = symmetric_body(Superelement(SPINDLE.positions(), own.mass, own.stiffness, own.polar))
    return Shaft("I", stations=SPINDLE.stations, superelement=body)


TEXT = rotor_text(by_matrices())


def test_modes_need_no_mass() -> None:
    """Without one, coordinates are mass-normalised."""
    kept = basis(SPINDLE, 4)
    body = Superelement(
        SPINDLE.positions(), np.eye(4), np.diag(kept.omega**2), kept.gyroscopic, kept.shapes
    )
    text = rotor_text(Shaft("modes", superelement=symmetric_body(body)))
    start = text.index("mass =")
    without = text[:start] + text[text.index("stiffness =") :]
    assert parse_rotor(without, "without") == parse_rotor(text, "with")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "[superelement]",
            "[[point_mass]]\n[superelement]",
            "point_mass .* cannot stand beside superelement",
        ),
        ('positions = "0.0 ', 'positions = "a ', "must be a block of finite numbers"),
        ('positions = "0.0 ', 'positions = "', "entry beyond|positions must be"),
        ('mass = """\n', 'mass = """\n1 2 3.0\n', "above the diagonal"),
        ('mass = """\n', 'mass = """\n1 1 3.0\n', "two entries at one place"),
        ('mass = """\n', 'mass = """\n900 1 0.1\n', "entry beyond its 40 rows and 40 columns"),
        ('stiffness = """\n1 1 ', 'stiffness = """\n1 1 -', "K is not positive"),
    ],
)
def test_a_mistake_is_told_with_its_place(old: str, new: str, says: str) -> None:
    assert old in TEXT
    with pytest.raises(TouchdownError, match=says) as error:
        parse_rotor(TEXT.replace(old, new, 1), "my.toml")
    assert str(error.value).startswith("my.toml: ")
    assert "\n" not in str(error.value)


def test_what_takes_diameters_is_absent() -> None:
    shaft = by_matrices()
    model = flexible_rotor(shaft, "I")
    for name in ("stress.active", "stress.node", "stress.bending", "node[1].peak_bending"):
        assert model.rename(name) is None
    assert model.rename("station[1].x") == f"{shaft.stations[0].name}.x"
    assert "40 coordinates per plane" in model.about
    lying = rotor_properties(shaft, 4, [0.0]).rest
    assert lying is not None
    assert len(lying.bending) == 0


def test_few_modes_lie_on_few_supports() -> None:
    kept = basis(SPINDLE, 3)
    modes = Superelement(
        SPINDLE.positions(), np.eye(3), np.diag(kept.omega**2), kept.gyroscopic, kept.shapes
    )
    shaft = Shaft("few", superelement=symmetric_body(modes))
    held = [(node, np.inf) for node in (2, 6, 12, 19)]
    assert at_rest(shaft, held[::3]).reactions.sum() == pytest.approx(9.81 * SPINDLE.mass, rel=1e-9)
    with pytest.raises(TouchdownError, match="few has 3 modes, too few to lie on 4 nodes"):
        at_rest(shaft, held)
