"""What a host may change once a run has begun: tunable parameters, and how long it is to be."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from slave_driver import STEP, Slave

from touchdown.fmus.recipes import recipe
from touchdown.modelkit.instance import Instance

Native = Callable[[str], Path]
DRAG = 0.5  # N m


def braked(slave: Slave) -> list[float]:
    """Speeds (rad/s) of a rotor: after two steps, after two under a drag, and after one set back."""
    slave.start({"speed": 100.0})
    found = []
    for number, drag in enumerate((None, None, DRAG, None, 0.0)):
        if drag is not None:
            slave.set({"drag": drag})
        slave.fmu.doStep(number * STEP, STEP)
        found.append(slave.get(["A.omega"])["A.omega"])
    return found


@pytest.fixture(params=["python", "native"])
def folder(request: pytest.FixtureRequest, unpacked: Mapping[str, Path], native: Native) -> Path:
    """A rotor's FMU of either kind."""
    return unpacked["rigid_rotor"] if request.param == "python" else native("rigid_rotor")


def test_a_drag_that_is_set_between_steps_brakes(folder: Path):
    found = braked(Slave(folder))
    inertia = dict_of(folder)["inertia"]
    assert found[0] == found[1] == 100.0
    assert found[1] - found[2] == pytest.approx(DRAG / inertia * STEP, rel=1e-6)
    assert found[2] - found[3] == pytest.approx(DRAG / inertia * STEP, rel=1e-6)
    assert found[4] == found[3]


def test_a_state_goes_on_where_its_host_announced_a_later_end(folder: Path):
    """Its bytes are of an instance whose host announced the end of the step they were taken after."""
    short, long = Slave(folder, "short"), Slave(folder, "long")
    for slave, stop in ((short, STEP), (long, 2.0 * STEP)):
        slave.fmu.setupExperiment(startTime=0.0, stopTime=stop)
        slave.fmu.enterInitializationMode()
        slave.fmu.exitInitializationMode()
    short.fmu.doStep(0.0, STEP)
    saved = short.fmu.serializeFMUstate(short.fmu.getFMUstate())
    long.fmu.setFMUstate(long.fmu.deSerializeFMUstate(saved))
    long.fmu.doStep(STEP, STEP)
    assert short.refuses(short.fmu.doStep, STEP, STEP)
    assert long.refuses(long.fmu.doStep, 2.0 * STEP, STEP)


def dict_of(folder: Path) -> dict[str, float]:
    """Start values of parameters."""
    slave = Slave(folder)
    return {n: float(slave.variables[n].start) for n in slave.named("parameter")}


def test_a_bad_value_is_refused_at_the_next_step(folder: Path):
    slave = Slave(folder).start()
    slave.set({"drag": -1.0})
    assert slave.refuses(slave.fmu.doStep, 0.0, STEP)
    assert "drag = -1 N.m must be at least 0 N.m" in slave.said


def test_a_fixed_parameter_beside_a_tunable_one_is_refused(folder: Path):
    slave = Slave(folder).start()
    references = [slave.variables[name].valueReference for name in ("drag", "mass")]
    assert slave.refuses(slave.fmu.setReal, references, [1.0, 1.0])
    assert "mass cannot be set as real now" in slave.said
    assert "drag cannot" not in slave.said


def held(times: list[float | None]) -> list[float]:
    """Force (N) of a magnetic bearing at each step; its shutdown is set before those with a time (s)."""
    instance = Instance(recipe("amb").model)
    at = {s.variable.name: s.index for s in instance.slots}
    instance.reals[at["journal.y"]] = -1e-5
    instance.reals[at["journal.inv_m"]] = 0.5
    mode = {"inv_m": 0.1, "k_over_m": 1e6, "c_over_m": 10.0}
    for name, value in mode.items():
        instance.reals[at[f"journal.mode[1].{name}"]] = value
    instance.start(0.0)
    found = []
    for number, shutdown in enumerate(times):
        if shutdown is not None:
            instance.reals[at["shutdown_time"]] = shutdown
            instance.tune()
        instance.step(number * STEP, STEP)
        found.append(instance.reals[at["journal.fy"]])
    return found


def test_a_host_shuts_a_magnetic_bearing_down_when_it_likes():
    """Beside elastic modes, which constants that are derived again must leave as they are."""
    kept, cut = held([None] * 6), held([None, None, None, 0.0, None, None])
    assert cut[:3] == kept[:3]
    assert all(kept)
    assert cut[3:] == [0.0, 0.0, 0.0]
    assert held([None, None, None, 0.005, None, None]) == kept  # the same again
    later = held([None, None, None, 0.004, None, None])  # another, that has not come
    assert later == kept
