"""Slides from a loop: loops of known slides, a measured one's noise, and tables that are none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from places import ROOT

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.studies.machine.hysteresis import Loop, fit, legs_of, read_loop

SPRING, REACH = 1e7, 60e-6  # N/m, m
Slides = list[tuple[float, float]]


def loop(slides: Slides, noise: float = 0.0, cycles: float = 2.25) -> Loop:
    """To and fro from rest, 200 points a cycle; noise: over the largest force."""
    way = REACH * np.sin(2.0 * np.pi * np.linspace(0.0, cycles, int(200 * cycles) + 1))
    force, stretch = SPRING * way, np.zeros(len(slides))
    for i in range(1, len(way)):
        for j, (k, most) in enumerate(slides):
            stretch[j] = np.clip(stretch[j] + way[i] - way[i - 1], -most / k, most / k)
            force[i] += k * stretch[j]
    return Loop(way, force + noise * np.max(force) * np.random.default_rng(5).normal(size=len(way)))


@pytest.mark.parametrize("slides", [[(2e7, 200.0)], [(1e7, 50.0), (5e6, 120.0)]])
def test_known_slides_are_found(slides: Slides) -> None:
    """Without noise as they are, and no more of them."""
    found = fit(loop(slides))
    assert found.spring == pytest.approx(SPRING, rel=1e-6)
    assert len(found.slides) == len(slides)
    np.testing.assert_allclose(found.slides, slides, rtol=1e-6)
    heat = sum(4.0 * force * (REACH - force / k) for k, force in slides)
    assert found.loss == pytest.approx(heat, rel=1e-6)
    assert found.measured == pytest.approx(heat, rel=2e-3)  # 200 points a cycle
    whole = loop(slides, cycles=3.0)
    cycle = slice(250, 451)  # closed, it may begin anywhere
    again = fit(Loop(whole.way[cycle], whole.force[cycle]))
    np.testing.assert_allclose(again.slides, slides, rtol=1e-3)


def test_noise_moves_them_a_little() -> None:
    """One per cent of the force: heat within 2 % and stiffness within 10 %, found 1 and 8 %."""
    slides = [(1e7, 50.0), (5e6, 120.0)]
    found = fit(loop(slides, 0.01), 2)
    assert found.loss == pytest.approx(sum(4.0 * f * (REACH - f / k) for k, f in slides), rel=0.02)
    assert found.spring == pytest.approx(SPRING, rel=0.1)
    both_ends = 0.01 * np.sqrt(2.0) * found.force  # of a leg
    assert found.misfit == pytest.approx(both_ends, rel=0.5)


def test_what_is_no_loop_is_refused() -> None:
    one_way = loop([(2e7, 200.0)], cycles=0.25)
    back = Loop(-loop([(2e7, 200.0)]).way, loop([(2e7, 200.0)]).force)
    for wrong, said in (
        (Loop(np.arange(5.0), np.arange(5.0)), "it needs 10"),
        (Loop(np.zeros(50), np.ones(50)), "cannot be fitted"),
        (back, "what it resists with"),
    ):
        with pytest.raises(TouchdownError, match=said):
            legs_of(wrong)
    assert len(legs_of(one_way)) == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has no row below its header"),
        ("way,force\n1,2\n", "there is no column displacement"),
        ("displacement [kg],force [N]\n1,2\n", "has the unit kg"),
        ("displacement [m],force\n1,2\n", "line 1: force has no unit"),
        ("displacement [mm];force [N]\n1;2\n1;x\n", "line 3: force = 'x' is not a number"),
        ("displacement [m],force [N]\n1\n", "line 2: force is missing"),
        (
            "displacement [m],displacement raw,force [N]\n1,1,2\n",
            "line 1: there are two columns displacement",
        ),
    ],
)
def test_tables_that_cannot_be_read(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "loop.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(TouchdownError, match=said):
        read_loop(path)
    with pytest.raises(TouchdownError, match="cannot read"):
        read_loop(tmp_path / "none.csv")
    path.write_text("Weg [mm];note;Kraft [kN];;\n1;;2;;\n3;up;4\n", encoding="utf-8")
    found = read_loop(path)  # only displacement and force must be filled
    assert (found.way.tolist(), found.force.tolist()) == ([1e-3, 3e-3], [2e3, 4e3])


def test_the_example_becomes_a_machine_s_mount(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Loop, file, picture, machine; mass by the rule of housings, as a loop has none."""
    example = ROOT / "examples" / "mount_loop.csv"
    monkeypatch.chdir(tmp_path)
    assert main(["import", "mount", str(example), "-o", "ribbon.toml"]) == 0
    assert "slide 2" in capsys.readouterr().out
    assert (tmp_path / "ribbon.png").stat().st_size > 10_000
    assert main(["import", "mount", str(example), "-o", "ribbon.toml", "--slides", "1"]) == 2
    assert "is there already" in capsys.readouterr().err
    scene = touchdown.new("mine", "6014", mass="60 kg", mount="ribbon.toml")
    with opened(scene, in_process=True) as system:
        assert system.value("housing.slide[2].force") == pytest.approx(120.0, rel=0.05)
        assert system.value("housing.spring.xx") == pytest.approx(8e6, rel=0.01)
        assert system.value("housing.mass") == pytest.approx(9.0)
