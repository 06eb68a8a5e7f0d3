"""Controllers that sample by their own clocks, less often than the bearings."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from levitation import FILTER, KD, KI, KP, PERIOD, from_sample_to_sample
from systems import history

import touchdown
from touchdown.command.verbs.scenes import chosen_scene
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.loop.linear_loops import Sampled, loops_of
from touchdown.studies.loop.over_speed import loops_in

DISK = "disk-caged-relevitated"


def scene(ratio: int, **more: object) -> Scene:
    """The disk without weight, its controller by its own clock every `ratio` samples."""
    own = {"controller.clock": "own", "controller.sample_time": ratio * PERIOD, "rotor.gravity": 0.0}
    off = {f"controller.event[{k}].kind": "none" for k in (1, 2)}
    return load_scene(DISK).set({**own, **off, "rotor.speed": 0.0, **more})


def simulated(ratio: int, states: np.ndarray, added: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An axis from one sample that is used to the next, tick by tick, and what was sampled.

    states (8, n): u, u', force, signal, set point that acts, I, D, last m; added (n,): to the sample (m).
    """
    ahead = from_sample_to_sample(PERIOD, gravity=0.0)
    period = ratio * PERIOD
    whole, i, d, last = states[:5], states[5], states[6], states[7]
    m = -(whole[3] + added)
    i = i + KI * period * m
    d = (d + KD * FILTER * (m - last)) / (1.0 + FILTER * period)
    set_point = KP * m + i + d
    for tick in range(ratio):
        if tick == 1:  # it acts from the next tick of the bearing on
            whole = np.vstack([whole[:4], set_point])
        whole = ahead @ whole
    if ratio == 1:
        whole = np.vstack([whole[:4], set_point])
    return np.vstack([whole, i, d, m]), -m


@pytest.mark.parametrize("ratio", [1, 2, 3])
def test_poles_and_sensitivity_are_those_of_a_simulated_loop(ratio: int) -> None:
    found = loops_in(scene(ratio), [0.0])
    loops = found.loops
    assert isinstance(loops, Sampled)
    assert loops.period == pytest.approx(ratio * PERIOD, rel=1e-12)
    over, _ = simulated(ratio, np.eye(8), np.zeros(8))
    values = np.linalg.eigvals(over)
    rates = np.log(values[np.abs(values) > 1e-6].astype(complex)) / loops.period
    for rate in rates[(np.abs(rates) < 2000.0) & (rates.imag >= 0.0)]:
        assert np.abs(found.own.poles - rate).min() < 1e-7 * abs(rate)
    assert (np.max(rates.real) < 0.0) == (found.own.unstable is None)
    for hz in (20.0, 70.0, 400.0):
        omega = 2.0 * math.pi * hz
        states = np.zeros((8, 1), complex)
        for k in range(round(1.5 / loops.period)):  # the slowest pole lies at -6 1/s: e^-9 is left
            added = np.exp(1j * omega * k * loops.period)
            states, seen = simulated(ratio, states, np.array([added]))
        s = loops.closed(0.0).balanced().sensitivity(np.array([omega]))[0, 0, 0]
        assert seen[0] / added == pytest.approx(s, rel=1e-3)


def test_its_own_clock_at_the_bearing_s_rate_changes_nothing() -> None:
    plain, own = (loops_of(scene(1, **{"controller.clock": clock})) for clock in ("tick", "own"))
    omega = np.geomspace(10.0, 3e4, 50)
    one, other = (loops.closed(0.0).sensitivity(omega) for loops in (plain, own))
    assert one == pytest.approx(other, rel=1e-9)


@pytest.mark.parametrize(("ratio", "step"), [(2, 5e-5), (2, 1e-4), (3, 2e-5)])
def test_the_rotor_rings_at_the_pole(ratio: int, step: float) -> None:
    """Of the nonlinear run, from 1 um: the pair that swings, to 0.1 %."""
    run = scene(ratio, **{"rotor.x": 1e-6, "run.macro_step": step, "run.duration": "60 ms"})
    times, values, _ = history(run, ["rotor.A.x"])
    period = ratio * PERIOD
    at = np.rint(np.arange(1, round(0.055 / period)) * period / step).astype(int) - 1
    assert np.allclose(times[at] / period, np.rint(times[at] / period), atol=1e-6)
    x = values["rotor.A.x"][at]
    rows = np.array([x[i : i + len(x) // 3] for i in range(len(x) - len(x) // 3)])
    v = np.linalg.svd(rows, full_matrices=False)[2][:5]
    roots = np.log(np.linalg.eigvals(v[:, 1:] @ np.linalg.pinv(v[:, :-1])).astype(complex)) / period
    poles = loops_in(run, [0.0]).own.poles
    pole = min((p for p in poles if p.imag > 50.0), key=abs)
    assert np.abs(roots - pole).min() < 1e-3 * abs(pole)


def test_a_law_from_a_file_has_its_own_sample_time(tmp_path: Path) -> None:
    """The PID as a file for 200 us is the PID that samples as often."""
    period = 2.0 * PERIOD
    lag = 1.0 + FILTER * period
    law = {
        "A": [[1.0, 0.0, 0.0], [0.0, 1.0 / lag, -KD * FILTER / lag], [0.0, 0.0, 0.0]],
        "B": [[KI * period], [KD * FILTER / lag], [1.0]],
        "C": [[1.0, 1.0 / lag, -KD * FILTER / lag]],
        "D": [[KP + KI * period + KD * FILTER / lag]],
        "sample_time": period,
    }
    file = tmp_path / "law.json"
    file.write_text(json.dumps(law), encoding="utf-8")
    by_file = chosen_scene(DISK, swap=[f"controller={file}"])
    by_file = by_file.set({"rotor.gravity": 0.0, "rotor.speed": 0.0})
    poles, others = (loops_in(one, [0.0]).own.poles for one in (by_file, scene(2)))
    for pole in others[np.abs(others) < 5000.0]:
        assert np.abs(poles - pole).min() < 1e-6 * max(abs(pole), 1.0)
    history(by_file.set({"run.duration": "2 ms"}), ["rotor.A.x"])


@pytest.mark.parametrize("period", [1.5e-4, 0.5e-4])
def test_other_ratios_are_refused(period: float) -> None:
    with pytest.raises(TouchdownError, match="multiple"):
        loops_of(scene(1, **{"controller.sample_time": period}))


def test_a_loop_of_two_clocks_is_not_measured() -> None:
    with pytest.raises(TouchdownError, match=r"controllers sample every 0\.0002 s by their clocks"):
        touchdown.amb_margins(scene(2), measure=True)


@pytest.mark.parametrize(("period", "said"), [(0.5 * PERIOD, 1), (PERIOD, 0), (2.0 * PERIOD, 0)])
def test_a_clock_faster_than_the_samples_is_said(period: float, said: int) -> None:
    with opened(scene(1, **{"controller.sample_time": period}), in_process=True) as system:
        shorter = [line for line in system.remarks if "is shorter than amb.sample_time" in line]
    assert len(shorter) == said
