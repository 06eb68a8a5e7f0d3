"""What FMUs declare of their steps, said where the macro step does not go with it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from archives import saying

import touchdown
from touchdown.fmus.build import cached_fmu
from touchdown.fmus.recipes import recipe
from touchdown.master.coupling.assembly import declared_steps
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.scene import ComponentSpec

SCENE = touchdown.load("disk-caged-simplified")


def said(inner: float | None, proposed: float | None, step: float = 2e-5) -> list[str]:
    """Of a scene all of whose components declare the same; the bearing takes two macro steps in one."""
    scene: Any = SimpleNamespace(
        run=SimpleNamespace(macro_step=step), components={"bearing": ComponentSpec("x", every=2)}
    )
    component: Any = SimpleNamespace(inner_step=inner, made_for_step=proposed, any_step=True)
    return list(declared_steps(scene, {"bearing": component}))


@pytest.mark.parametrize("inner", [None, 4e-5, 4e-5 / 3.0])
def test_steps_that_go_into_the_macro_step_are_not_remarked_on(inner: float | None) -> None:
    assert said(inner, 5e-6) == []


@pytest.mark.parametrize("inner", [3e-5, 8e-5])
def test_steps_that_do_not_are(inner: float) -> None:
    (line,) = said(inner, None)
    assert line.startswith(f"bearing steps by {inner:g} s inside (fixedInternalStepSize of its FMU)")
    assert "its macro step of 4e-05 s is not a multiple" in line


def test_a_macro_step_that_an_fmu_was_not_made_for(tmp_path: Path) -> None:
    """An FMU of others, for steps of 1 us; the project's own say nothing, whatever they propose."""
    proposed = 'stepSize="2e-05"', 'stepSize="1e-06"'
    other = saying(cached_fmu(recipe("housing")), tmp_path / "other.fmu", *proposed)
    scene = SCENE.swap(housing=str(other))
    with opened(scene, in_process=True) as system:
        (line,) = system.remarks
    assert line.startswith(
        "housing was made for steps of 1e-06 s (stepSize of its FMU's DefaultExperiment)"
    )
    assert line.endswith("its macro step of 0.0001 s is far longer")
    with opened(SCENE.set({"run.macro_step": 1e-4}), in_process=True) as system:
        assert list(system.remarks) == []
