"""Energy made inside a bearing, or by a body, is told, and stops a run; shipped scenes make little."""

from __future__ import annotations

import pytest

from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.scene.file import load_scene


def dropped(**settings: object) -> Outcome:
    scene = load_scene("disk-cageless-detailed").set({"amb.shutdown_time": 1e-3, "run.duration": 0.012})
    with opened(scene.set(settings), in_process=True) as system:
        return simulate(scene, system)


def damage(monkeypatch: pytest.MonkeyPatch, component: str, times: float) -> None:
    """Add energy from nowhere to the heat that a component states."""
    read = InProcessComponent.read

    def damaged(self: InProcessComponent, names: list[str]) -> list[float]:
        values = read(self, names)
        if self.name == component and names == ["energy.dissipated"]:
            time = read(self, ["contact.peak_force" if component == "bearing" else "A.y"])[0]
            values[0] += times * abs(time)
        return values

    monkeypatch.setattr(InProcessComponent, "read", damaged)


def test_energy_made_inside_a_bearing_stops_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    damage(monkeypatch, "bearing", 1.0)
    outcome = dropped()
    assert "the inside of bearing made" in outcome.reason
    assert "--set bearing.micro_step=1.25e-06 or --set bearing.balls.damping_ratio=0.02" in outcome.reason
    assert outcome.reason.endswith("the steps are not to blame, but the model: report it")


def test_the_advice_names_what_else_may_make_energy(monkeypatch: pytest.MonkeyPatch) -> None:
    """A smaller step does not help where a law does it."""
    damage(monkeypatch, "bearing", 1.0)
    outcome = dropped(**{"bearing.ring.harmonics": 2, "bearing.ring.growth": 1})
    parts = "bearing.ring.harmonics, bearing.ring.growth"
    assert f"if that leaves as much, the steps are not to blame, but the model: set {parts} to 0" in (
        outcome.reason
    )


def test_energy_made_by_a_body_stops_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    damage(monkeypatch, "rotor", 1e3)
    outcome = dropped()
    assert outcome.reason.startswith("the system made")


def test_a_shipped_scene_is_not_in_doubt() -> None:
    outcome = dropped()
    assert not outcome.reason
    assert outcome.warned_at is None
    assert outcome.inside is not None
    assert outcome.inside < 2e-3
    assert outcome.in_system is not None
    assert outcome.in_system < 2e-3
