"""Laws from files: what is read, what is refused, and C(z) of C(s) against scipy and closed forms."""

from __future__ import annotations

import contextlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import io, linalg, signal

from touchdown.bearings.magnetic.law_file import MATCHED, TUSTIN, Law, law_of, read_law
from touchdown.bearings.magnetic.state_space import controller
from touchdown.modelkit.errors import TouchdownError
from touchdown.modelkit.instance import Instance

PERIOD = 1e-4
HERTZ = np.array([50.0, 200.0, 500.0, 1500.0, 4000.0])
GENERATOR = np.random.default_rng(7)
LEAD = {"sos": [[0.0, 1 / 300.0, 1.0, 0.0, 1 / 9000.0, 1.0]], "gain": 9e3}  # (1 + s/300)/(1 + s/9000)


def two_by_two(n: int = 5) -> dict[str, Any]:
    """A stable law of both axes of a bearing, in continuous time."""
    a = GENERATOR.normal(size=(n, n)) * 300.0
    a -= (np.abs(np.linalg.eigvals(a)).max() + 50.0) * np.eye(n)
    shapes = {"B": (n, 2), "C": (2, n), "D": (2, 2)}
    return {"A": a} | {name: GENERATOR.normal(size=shape) for name, shape in shapes.items()}


def sampled(model_law: Law, **settings: float) -> Instance:
    """Its controller, fed by the samples of a bearing."""
    one = Instance(controller(model_law, "law"))
    one.record["u"]["period"] = PERIOD
    one.record["p"]["limit"] = 1e12
    for name, value in settings.items():
        one.record["u" if name == "speed" else "p"][name] = value
    one.start(0.0)
    return one


def answers(one: Instance, places: np.ndarray) -> np.ndarray:
    """Set points (n, 4), A, for positions (n, 4), m."""
    u, found = one.record["u"], []
    for k, place in enumerate(places):
        u["axis"]["sensed"] = place
        u["tick"] += 1.0
        one.step(k * PERIOD, PERIOD)
        found.append(one.record["o"]["axis"]["set"].copy())
    return np.array(found)


@pytest.mark.parametrize("ending", [".json", ".npz", ".mat"])
def test_every_format_holds_the_same(ending: str, tmp_path: Path):
    """At two speeds, with a text and single numbers; MATLAB has the speed last, and calls it Ts."""
    ones = [two_by_two(), two_by_two()]
    stacked: dict[str, Any] = {name: np.stack([one[name] for one in ones]) for name in "ABCD"}
    beside = {"speeds": [0.0, 900.0], "gives": "force", "sample_time": PERIOD}
    path = tmp_path / f"law{ending}"
    if ending == ".json":
        path.write_text(json.dumps({**{n: m.tolist() for n, m in stacked.items()}, **beside}))
    elif ending == ".npz":
        np.savez(path, **stacked, **beside)
    else:
        turned = {name: np.moveaxis(matrix, 0, -1) for name, matrix in stacked.items()}
        io.savemat(path, {**turned, "speeds": [0.0, 900.0], "gives": "force", "Ts": PERIOD})
    law = read_law(path)
    again = law_of(json.loads(law.text), "again")
    for one in (law, again):
        assert (one.sample_time, one.force, one.speeds.tolist()) == (PERIOD, True, [0.0, 900.0])
        assert all(np.array_equal(getattr(one, name), stacked[name]) for name in "ABCD")


def test_twelve_sections_are_those_of_scipy():
    sos: Any = signal.ellip(24, 0.5, 60.0, 0.3, output="sos")
    assert sos.shape == (12, 6)
    one = sampled(law_of({"sos": sos.tolist(), "gain": -2.5, "sample_time": "100 us"}, "f"))
    places = GENERATOR.normal(size=(500, 4))
    expected: Any = -2.5 * signal.sosfilt(sos, -places, axis=0)
    assert np.abs(expected).max() > 1.0
    assert np.abs(answers(one, places) - expected).max() < 1e-11


def test_a_law_of_both_axes_goes_for_each_bearing():
    law = law_of({**two_by_two(), "Ts": 0}, "f").sampled(PERIOD)
    one = sampled(law)
    places = GENERATOR.normal(size=(200, 4))
    found = answers(one, places)
    system: Any = signal.dlti(*(getattr(law, name)[0] for name in "ABCD"), dt=PERIOD)
    for axes in (slice(0, 2), slice(2, 4)):
        expected: Any = signal.dlsim(system, -places[:, axes])[1]
        assert found[:, axes] == pytest.approx(expected, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("exact_at", [0.0, 2 * math.pi * 900.0])
def test_tustin_is_scipy_s_with_another_step_where_it_is_exact_at_a_frequency(exact_at: float):
    law = law_of(two_by_two(), "f")
    found = law.sampled(PERIOD, TUSTIN, exact_at)
    step = 2 * math.tan(0.5 * exact_at * PERIOD) / exact_at if exact_at else PERIOD
    expected: Any = signal.cont2discrete([getattr(law, name)[0] for name in "ABCD"], step, "bilinear")
    for name, matrix in zip("ABCD", expected, strict=False):
        assert getattr(found, name)[0] == pytest.approx(matrix, rel=1e-9, abs=1e-12)
    known = law.response(np.array([1j * exact_at]))
    assert found.response(np.exp(1j * np.array([exact_at]) * PERIOD)) == pytest.approx(known, rel=1e-9)


def test_matched_poles_and_zeros_of_a_lead_in_closed_form():
    """And of an integrator with a pole at infinity: its zero is at -1, its size exact where it is asked."""
    law = law_of(LEAD, "f")
    zero, pole = np.exp(-300.0 * PERIOD), np.exp(-9000.0 * PERIOD)
    z = np.exp(1j * np.array([0.0, 500.0, 9000.0]) * PERIOD)
    expected = 9e3 * (z - zero) / (1 - zero) * (1 - pole) / (z - pole)
    assert law.sampled(PERIOD, MATCHED).response(z)[0, :, 0, 0] == pytest.approx(expected, rel=1e-9)
    w = 2000.0
    found = law_of({"sos": [[0, 0, 1, 0, 1, 0]], "gain": -4.0}, "f").sampled(PERIOD, MATCHED, w)
    at = np.exp(1j * w * PERIOD)
    expected = -4.0 / w * abs((at - 1) / (at + 1)) * (z[1:] + 1) / (z[1:] - 1)
    assert found.response(z[1:])[0, :, 0, 0] == pytest.approx(expected, rel=1e-9)


def low_passed_pid(order: int) -> tuple[list[list[float]], np.ndarray, np.ndarray, float]:
    """A PID's section and those of a low-pass of 1.5 kHz behind it; its zeros, poles and gain."""
    w = 2 * math.pi * 1500.0
    sos = [[9.3e4, 5.8e7, 2.4e8, 1.0, 6e3, 0.0]] + [[0.0, 0.0, w * w, 1.0, 1.4 * w, w * w]] * (order // 2)
    poles = np.concatenate([np.roots(row[3:]) for row in sos])
    return sos, np.roots(sos[0][:3]), poles, 9.3e4 * w**order


def response_of_matched(zeros: np.ndarray, poles: np.ndarray, gain: float) -> np.ndarray:
    """At HERTZ, of poles and zeros at exp(s T); of C(s)' size at a hundredth of the sampling frequency."""
    up, down = np.append(np.exp(zeros * PERIOD), -np.ones(len(poles) - len(zeros))), np.exp(poles * PERIOD)
    slow = 0.02 * math.pi / PERIOD
    known: Any = signal.freqs_zpk(zeros, poles, gain, [slow])[1]
    found: Any = signal.freqz_zpk(up, down, 1.0, np.append(slow, 2 * math.pi * HERTZ) * PERIOD)[1]
    return found[1:] * abs(known[0] / found[0])


def random_bases(n: int) -> np.ndarray:
    return np.random.default_rng(7).normal(size=(30, n, n))


def in_basis(law: Law, basis: np.ndarray) -> dict[str, Any]:
    """Its matrices for states that are `basis` times theirs."""
    a, b, c, d = (getattr(law, name)[0] for name in "ABCD")
    return {"A": np.linalg.solve(basis, a @ basis), "B": np.linalg.solve(basis, b), "C": c @ basis, "D": d}


def matched_of(data: dict[str, Any]) -> np.ndarray:
    """What C(z) is at HERTZ."""
    sampled = law_of(data, "f").sampled(PERIOD, MATCHED)
    return sampled.response(np.exp(2j * math.pi * HERTZ * PERIOD))[0, :, 0, 0]


@pytest.mark.parametrize("order", [0, 2, 4])
def test_matched_poles_and_zeros_do_not_depend_on_the_states(order: int):
    """Of sections, of scipy's form, and of 30 turned bases of balanced states."""
    sos, zeros, poles, gain = low_passed_pid(order)
    own = law_of({"sos": sos}, "f")
    scale = linalg.matrix_balance(own.A[0], permute=False, separate=True)[1][0]
    forms = [{"sos": sos}]
    forms.append(dict(zip("ABCD", signal.tf2ss(gain * np.poly(zeros), np.poly(poles)), strict=True)))
    for turn in random_bases(len(poles)):
        forms.append(in_basis(own, scale[:, None] * np.linalg.qr(turn)[0]))
    expected = response_of_matched(zeros, poles, gain)
    for data in forms:  # a double pole is known to the root of rounding
        assert matched_of(data) == pytest.approx(expected, rel=1e-6)


def test_matched_is_right_or_refused_where_rounding_hides_zeros():
    """Of turned bases of states that differ ever more in scale, by up to 1e10."""
    sos, zeros, poles, gain = low_passed_pid(4)
    expected, own, taken = response_of_matched(zeros, poles, gain), law_of({"sos": sos}, "f"), 0
    scale = linalg.matrix_balance(own.A[0], permute=False, separate=True)[1][0]
    turns = random_bases(len(poles))
    for reach, turn in zip(np.linspace(0.0, 5.0, len(turns)), turns, strict=True):
        apart = scale * 10.0 ** np.linspace(-reach, reach, len(poles))
        with contextlib.suppress(TouchdownError):
            assert matched_of(in_basis(own, apart[:, None] * np.linalg.qr(turn)[0])) == pytest.approx(
                expected, rel=1e-3
            )
            taken += 1
    assert 0 < taken < len(turns)


def test_the_deviation_of_an_integrator_in_closed_form():
    """Tustin's is 1/s at the frequency 2/T tan(w T/2), a fifth of the sampling's at most."""
    law = law_of({"sos": [[0, 0, 1, 0, 1, 0]]}, "f")
    one = sampled(law)
    angle = math.pi * 0.2
    assert one.record["o"]["law"]["deviation"] == pytest.approx(1 - angle / math.tan(angle), rel=1e-9)
    assert one.record["o"]["law"]["at"] == pytest.approx(2 * angle / PERIOD, rel=1e-9)


def test_between_speeds_matrices_are_interpolated_and_beyond_them_kept():
    """By the gain alone, which the first sample shows, then by the state, which the second does."""
    data = {"A": [[[0.5]], [[0.9]]], "B": [[1.0]], "C": [[1.0]], "D": [[[1.0]], [[3.0]]]}
    law = law_of({**data, "speeds": ["0 rpm", "9000 rpm"], "sample_time": PERIOD}, "f")
    for share, speed in ((0.0, 0.0), (0.25, 75 * math.pi), (1.0, 300 * math.pi), (1.0, 2e3)):
        found = answers(sampled(law, speed=speed), np.array([[-1.0] * 4, [0.0] * 4, [0.0] * 4]))[:, 0]
        assert found == pytest.approx([1 + 2 * share, 1.0, 0.5 + 0.4 * share], rel=1e-12)


def test_position_and_reference_apart():
    """Re-levitated from 200 um off, a law that takes the position alone sees how far the rotor came."""
    law = law_of({"D": [[1.0, 10.0]], "sample_time": PERIOD}, "f")
    one = sampled(law, ramp=1e-3)
    event = one.record["p"]["event"]
    event["time"][:2], event["kind"][:2] = (2 * PERIOD, 4 * PERIOD), (1, 2)
    places = np.array([0.0] * 4 + [-200e-6, -200e-6, -150e-6])[:, None] * np.ones(4)
    found = answers(one, places)[:, 0]
    assert found == pytest.approx([0, 0, 0, 0, 0, 10 * 20e-6, -50e-6 + 10 * 40e-6], abs=1e-12)


def test_a_law_of_forces_is_divided_by_k_i_and_added_to_the_holding_current():
    one = Instance(controller(law_of({"D": [[5.0]], "gives": "force", "Ts": PERIOD}, "f"), "f"))
    axis = one.record["u"]["axis"]
    axis["current_factor"], axis["hold"] = 25.0, 0.3
    one.start(0.0)
    assert one.record["o"]["axis"]["force_set"] == pytest.approx([7.5] * 4)
    found = answers(one, np.full((1, 4), -2.0))[0]
    assert found == pytest.approx([0.3 + 10.0 / 25.0] * 4)
    assert one.record["o"]["axis"]["force_set"] == pytest.approx(25.0 * found)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({"A": [[1]], "B": [[1, 2, 3]], "C": [[1]]}, "has 3 inputs and 1 outputs; there may be 1, 2"),
        ({"A": [[1, 0]], "B": [[1]], "C": [[1]]}, "A is 1 by 2; beside the others it must be 2 by 2"),
        ({"A": [[1]], "B": [[1], [2]], "C": [[1]]}, "B is 2 by 1; beside the others it must be 1 by 1"),
        ({"A": [[1]], "B": [[1]]}, "C is missing; it must be a matrix of numbers, row by row"),
        ({"A": [[1], [1, 2]], "B": [[1]], "C": [[1]]}, "A = .* must be a matrix of numbers, row by row"),
        ({"A": [1], "B": [[1]], "C": [[1]]}, "A = .* must be a matrix of numbers"),
        ({"A": [["x"]], "B": [[1]], "C": [[1]]}, "A = .* must be a matrix of numbers"),
        ({"D": [[math.nan]]}, "D = .* holds what is not a finite number"),
        ({"D": [[[1]], [[2]]], "speeds": [0, 1, 2]}, "D = .* is not of as many speeds as `speeds`, 3"),
        ({"D": [[1]], "speeds": [5, 1]}, "speeds = .* must be rising, and at most 8"),
        ({"D": [[1]], "sample_time": -1}, "sample_time = -1 must be at least 0 s"),
        ({"D": [[1]], "sample_time": "1 N"}, "sample_time = '1 N' has the unit N"),
        ({"D": [[1]], "gives": "voltage"}, "gives = 'voltage' is not known"),
        ({"D": [[1]], "E": 1}, "E is not a known key"),
        ({}, "has neither A, B, C and D, nor sos"),
        (
            {"sos": [[1, 0, 0, 1, 0, 0]], "D": [[1]]},
            "sos = .* stands beside A, B, C or D; give one of them",
        ),
        ({"sos": [[1, 0, 0, 1, 0]]}, "sos = .* must be rows of six"),
        ({"sos": [[1, 0, 0, 0, 1, 0]]}, "sos = .* has a section without a proper denominator"),
        ({"sos": [[1, 0, 0, 1, 0.5, 0.1]] * 25}, "has 50 states, and may have 1 to 48; reduce it"),
    ],
)
def test_what_cannot_be_a_law_is_one_line(data: dict[str, Any], said: str):
    with pytest.raises(TouchdownError, match=rf"^mine\.json: {said}") as caught:
        law_of(data, "mine.json")
    assert "\n" not in str(caught.value)


def test_files_that_are_damaged_or_of_another_kind(tmp_path: Path):
    for name, content, said in (
        ("a.json", b"{", "is not valid JSON"),
        ("a.npz", b"PK", "is damaged or not an archive of NumPy"),
        ("a.mat", b"nothing of MATLAB's" * 20, "is damaged or not MATLAB's"),
        ("b.mat", b"MATLAB 7.3".ljust(124) + b"\x00\x02IM", "is of MATLAB 7.3; save it with -v7"),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(TouchdownError, match=said):
            read_law(path)
    with pytest.raises(TouchdownError, match=r"cannot read controller .*none\.json"):
        read_law(tmp_path / "none.json")


def test_settings_that_a_law_cannot_take():
    continuous = law_of(two_by_two(), "both.json")
    for settings, said in (
        ({"method": MATCHED}, "method = matched is for one input and one output at one speed; take tustin"),
        ({"exact_at": 4e4}, "exact_at = 40000 rad/s is not below half the sampling frequency"),
        ({"sample_time": 5e-5}, "a sample_time of 5e-05 s, and the magnetic bearing one of 0.0001 s"),
    ):
        with pytest.raises(TouchdownError, match=said):
            sampled(continuous, **settings)
    for speeds, turning in (([0.0, 900.0], -1.0), ([-900.0, 0.0], 1.0)):
        scheduled = law_of({"D": [[[1.0]], [[3.0]]], "speeds": speeds, "sample_time": PERIOD}, "f")
        with pytest.raises(TouchdownError, match=rf"and the rotor's is {turning:g} rad/s; give the file"):
            sampled(scheduled, speed=turning)
        sampled(scheduled, speed=-turning)
    sampled(law_of({"D": [[1.0]], "sample_time": PERIOD}, "f"), speed=-900.0)
    known = sampled(law_of({"D": [[1.0]], "sample_time": PERIOD}, "f"))
    assert not {"sample_time", "method", "exact_at"} & {slot.variable.name for slot in known.slots}


def test_an_unstable_law_is_told_of_and_integrators_are_not():
    for a, period, unstable in ((1.0, PERIOD, 0), (1.001, PERIOD, 1), (0.0, 0.0, 0), (1.0, 0.0, 1)):
        law = law_of({"A": [[a]], "B": [[1.0]], "C": [[1.0]], "sample_time": period}, "f")
        assert sampled(law).record["o"]["law"]["unstable"] == unstable
