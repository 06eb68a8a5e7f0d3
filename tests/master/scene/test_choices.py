"""Choices by their words: in scenes and on the command line, of FMUs and of models in process."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.components.component import Component
from touchdown.master.components.description import interface
from touchdown.master.components.loading import Stepping, load_component
from touchdown.master.coupling.assembly import checked_value
from touchdown.master.scene.events import settings_at_times, settings_of
from touchdown.modelkit.kernel.cache_folder import user_cache
from touchdown.modelkit.reader import Table


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
        ("slip", "on", 1.0),
        ("slip", False, 0.0),
        ("balls.hertz", "printed", 1.0),
    ],
)
def test_words_and_numbers(name: str, given: object, number: float, bearing: Component):
    assert checked_value(bearing, name, given) == number


@pytest.mark.parametrize("given", ["colomb", 3, "1.5", True, "", None])
def test_what_is_no_choice_is_refused(given: object, bearing: Component):
    with pytest.raises(TouchdownError) as caught:
        checked_value(bearing, "friction.kind", given)
    assert str(caught.value) == (
        f"bearing.friction.kind = {given!r} is not one of its choices: coulomb (0), stribeck (1), "
        "makkar (2)"
    )


def test_an_fmu_tells_the_same(bearing: Component, built: Mapping[str, Path]):
    described, *_ = interface(built["simplified_caged"], user_cache())
    assert {n: v.choices for n, v in described.items()} == {
        n: v.choices for n, v in bearing.variables.items()
    }
    assert described["friction.kind"].in_words(2.0) == "makkar"
    assert described["balls.count"].in_words(9.0) == "9"


def test_what_can_be_set_is_listed_in_units_that_people_use(capsys: pytest.CaptureFixture[str]) -> None:
    """A choice has neither unit nor bounds beside its word; a control's bandwidth is no speed."""
    shown: dict[str, list[str]] = {}
    for component in ("bearing", "rotor", "amb"):
        assert main(["scenes", "disk-caged-simplified", "--variables", component]) == 0
        lines = capsys.readouterr().out.splitlines()
        shown |= {f"{component}.{words[0]}": words for line in lines if (words := line.split())}
    assert shown["bearing.clearance"][1:5] == ["300", "um", "from", "0"]
    assert shown["bearing.interface.order"][1:3] == ["model", "motion"]
    assert shown["rotor.speed"][1:3] == ["9000", "rpm"]
    assert shown["amb.bandwidth"][1:3] == ["0", "Hz"]


def test_a_name_that_is_begun_is_answered_by_those_it_begins() -> None:
    """Before those that merely look alike."""
    known = ("friction.dynamic", "friction.static", "fraction", "mass")
    assert one_of("frict", known) == "did you mean friction.dynamic or friction.static"
    assert one_of("masss", known) == "did you mean mass"


@pytest.mark.parametrize(
    ("what", "settings"),
    [
        ("amb: coil_short all", {"kind": "coil_short"}),
        ("amb: sensor_lost both", {"kind": "sensor_lost"}),
        ("amb: coil_off 2", {"kind": "coil_off", "coil": 2}),
    ],
)
def test_events_of_one_or_all(what: str, settings: dict[str, object]):
    event = settings_of(settings_at_times([Table("event: ", {"time": "5 ms", "what": what})]), "amb")
    assert event == {"event[1].time": 5e-3} | {f"event[1].{key}": value for key, value in settings.items()}
