"""What a scene has to compile is compiled before it runs, by processes beside each other."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import pytest

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components import compile_ahead
from touchdown.master.results.run import make_ready
from touchdown.modelkit.kernel import machine_code


@pytest.fixture
def handed_out(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Titles of the models that each process would be handed; nothing is compiled."""
    lists: list[list[str]] = []

    def take(models: Iterable[compile_ahead.NewModel]) -> None:
        lists.append([model.title for model in models])

    monkeypatch.setattr(compile_ahead, "_have_compiled", take)
    monkeypatch.setattr(compile_ahead, "_compile", lambda model: take([model]))
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1})
    return lists


@pytest.mark.parametrize("in_process", [True, False])
def test_each_new_model_is_handed_out_once(
    in_process: bool, own_cache: Path, handed_out: list[list[str]]
) -> None:
    said: list[str] = []
    make_ready([touchdown.load("rotor1-9000")], in_process, said.append)
    titles = [title for titles in handed_out for title in titles]
    assert sorted(titles) == ["amb", "housing", "rotor_I", "simplified_cageless"]
    assert len(said) == 1
    assert all(title in said[0] for title in titles)


def test_effects_that_act_have_their_own_kernel(own_cache: Path, handed_out: list[list[str]]) -> None:
    """Each kernel that some of the scenes need is compiled, and no other."""
    scene = touchdown.load("disk-caged-simplified")

    def acting(*settings: dict[str, object]) -> list[list[str]]:
        models = compile_ahead.new_models([scene.set(values) for values in settings], True)
        return [list(model.effects) for model in models if model.title == "simplified_caged"]

    assert acting({}, {"bearing.thermal": "off"}) == [[]]
    assert acting({"bearing.thermal": "on"}, {"bearing.ring.growth": 1}) == [["thermal"]]
    assert acting({}, {"bearing.ring.growth": "1"}) == [[], ["ring.growth"]]


def test_an_interrupt_begins_no_more(own_cache: Path, handed_out: list[list[str]]) -> None:
    make_ready([touchdown.load("rotor1-9000")], True, stop=lambda: True)
    assert len(handed_out) <= 1  # those that were handed to the other process


def test_one_processor_compiles_as_it_goes(
    own_cache: Path, handed_out: list[list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0})
    make_ready([touchdown.load("rotor1-9000")], True, pytest.fail)
    assert not handed_out


@pytest.mark.slow
@pytest.mark.parametrize("in_process", [True, False])
def test_what_is_compiled_is_not_new(
    in_process: bool, own_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither in process nor as an FMU, whichever of them it was compiled for."""
    scene = touchdown.load("disk-caged-simplified")

    def is_new(way: bool) -> bool:
        return "housing" in {model.title for model in compile_ahead.new_models([scene], way)}

    assert is_new(True)
    assert is_new(False)
    (housing,) = (m for m in compile_ahead.new_models([scene], in_process) if m.title == "housing")
    compile_ahead._have_compiled(iter([housing]))
    assert not is_new(True)
    assert not is_new(False)
    monkeypatch.setattr(machine_code, "is_tried", lambda: False)  # numba is another one: nothing is shared
    assert not is_new(True)
    assert is_new(False)


def test_a_mistake_does_not_wait_for_the_compiler(own_cache: Path, handed_out: list[list[str]]) -> None:
    scene = touchdown.load("rotor1-9000").set({"bearing_A.weight": 1.0})
    with pytest.raises(TouchdownError, match="no variable weight"):
        make_ready([scene], False)
    assert not handed_out
