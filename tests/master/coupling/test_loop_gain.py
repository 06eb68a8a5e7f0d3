"""Algebraic loops between foreign FMUs: those that run away are named, with their gain."""

from __future__ import annotations

from pathlib import Path

import pytest
from pythonfmu import FmuBuilder

from touchdown.master.common.errors import Ended
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.scene.file import parse_scene

SCRIPT = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

class Gain(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u, self.y, self.k = 0.0, 0.0, 0.0
        self.register_variable(Real("u", causality=Fmi2Causality.input))
        self.register_variable(Real("y", causality=Fmi2Causality.output))
        self.register_variable(
            Real("k", causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
        )

    def do_step(self, time, step):
        self.y = 1.0 + self.k * self.u
        return True
"""


@pytest.fixture(scope="module")
def gain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An FMU whose output is 1 + k u."""
    folder = tmp_path_factory.mktemp("gain")
    (folder / "gain.py").write_text(SCRIPT, encoding="utf-8")
    return Path(FmuBuilder.build_FMU(folder / "gain.py", dest=folder))


def joined(gain: Path, first: float, second: float) -> Outcome:
    """Two of them, each feeding the other."""
    components = {name: {"fmu": str(gain), "set": {"k": k}} for name, k in (("a", first), ("b", second))}
    wires, run = [["a.y", "b.u"], ["b.y", "a.u"]], {"macro_step": 1e-4, "duration": 0.02}
    scene = parse_scene({"components": components, "connect": wires, "run": run}, "loop", gain.parent)
    scene = scene.set({"*.isolate": False})
    with opened(scene) as system:
        return simulate(scene, system)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_loop_that_runs_away_is_named_with_its_gain(gain: Path, sign: float) -> None:
    outcome = joined(gain, -1.5, -1.5 * sign)
    assert outcome.ended is Ended.STOPPED
    assert f"changes by {2.25 * sign:.3g} times as much with every macro step" in outcome.reason
    assert "the loop " in outcome.reason
    assert outcome.steps < 20


@pytest.mark.parametrize("gains", [(-0.9, 0.9), (0.5, 0.5), (0.0, 2.0)])
def test_a_loop_that_settles_runs_on(gain: Path, gains: tuple[float, float]) -> None:
    assert joined(gain, *gains).ended is Ended.COMPLETED
