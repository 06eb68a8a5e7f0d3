"""Choices by their words: in scenes and on the command line, of FMUs and of models in process."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import Component
from touchdown.master.components.interface import interface
from touchdown.master.components.library.loading import Stepping, load_component
from touchdown.master.coupling.assembly import checked
from touchdown.modelkit.kernel.cache_folder import user_cache


@pytest.fixture(scope="module")
def bearing() -> Component:
    """A bearing in process."""
    return load_component("bearing", "simplified_caged", stepping=Stepping(in_process=True))


@pytest.mark.parametrize(
    ("name", "given", "number"),
    [
        ("friction.kind", "coulomb", 0.0),
        ("friction.kind", " Stribeck ", 1.0),
        ("friction.kind", "2", 2.0),
        ("friction.kind", 0, 0.0),
        ("slip", "on", 1.0),
        ("slip", True, 1.0),
        ("slip", False, 0.0),
        ("slip", "true", 1.0),
        ("balls.hertz", "printed", 1.0),
    ],
)
def test_words_and_numbers(name: str, given: object, number: float, bearing: Component):
    assert checked(bearing, name, given) == number


@pytest.mark.parametrize("given", ["colomb", 3, -1, "1.5", True, "", "1 mm", "nan", None])
def test_what_is_no_choice_is_refused(given: object, bearing: Component):
    with pytest.raises(TouchdownError) as caught:
        checked(bearing, "friction.kind", given)
    assert str(caught.value) == (
        f"bearing.friction.kind = {given!r} is none of its choices: coulomb (0), stribeck (1), makkar (2)"
    )


def test_words_of_what_is_no_choice(bearing: Component):
    with pytest.raises(TouchdownError, match=r"bearing\.clearance = 'on' is not a number"):
        checked(bearing, "clearance", "on")


def test_an_fmu_tells_the_same(bearing: Component, built: Mapping[str, Path]):
    described, _ = interface(built["simplified_caged"], user_cache())
    assert {n: v.choices for n, v in described.items()} == {
        n: v.choices for n, v in bearing.variables.items()
    }
    assert described["friction.kind"].told(2.0) == "makkar"
    assert described["balls.count"].told(9.0) == "9"
