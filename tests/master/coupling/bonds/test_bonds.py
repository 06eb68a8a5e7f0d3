"""What bonds promise: two FMUs that know nothing of each other move as if they were one system."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import BondSpec, ComponentSpec, Scene, Wire
from touchdown.validation import bodies

MOTION = ("s1.x", "s1.v", "s2.x", "s2.v")
POSITION_ONLY, VELOCITY_ONLY = bodies.TWO[:2], bodies.TWO[::2]
STUBBORN, RIGID = bodies.Kind(states=False, any_step=False), bodies.Kind(any_step=False)


def moved(scene: Scene, names: tuple[str, ...] = MOTION) -> tuple[np.ndarray, Outcome]:
    """`names` at the end of every macro step, a row each, and the outcome; FMUs step in this process."""
    rows: list[list[float]] = []
    scene = scene.set({"*.isolate": False})
    with opened(scene) as system:
        watch = EveryStep(lambda now: rows.append([system.value(name) for name in names]))
        outcome = simulate(scene, system, observers=[watch])
    return np.array(rows), outcome


def error(rows: np.ndarray, step: float, damping: float = 0.0) -> float:
    """Largest of both masses' positions (m)."""
    exact = bodies.exact_oscillator(np.arange(len(rows) + 1) * step, damping)[1:]
    return float(np.max(np.abs(rows - exact)[:, ::2]))


def made(rows: np.ndarray) -> float:
    """Energy at the end over that at the begin, less 1; undamped."""
    return float(bodies.energy(rows[-1:])[0] / 1e4 - 1.0)


def run_of(step: float, duration: float, **more: object) -> dict[str, object]:
    return {"macro_step": step, "duration": duration, **more}


# -- two masses on springs ----------------------------------------------------------------------------


def test_two_masses_swing_as_one_system_and_the_outcome_says_how(body: Path) -> None:
    """For longer they do in `touchdown validate two-masses`."""
    rows, outcome = moved(bodies.scene(body, bodies.oscillator(), run=run_of(1e-3, 1.0)))
    assert error(rows, 1e-3) < 2e-5
    assert abs(made(rows)) < 5e-6
    assert outcome.warned_at is None
    assert outcome.exchange == "s1.f on s2.f_in by smooth; stepped in the order s1, s2"


@pytest.mark.parametrize(
    ("wires", "follows", "bonds"), [(POSITION_ONLY, 0.0, "contact"), (VELOCITY_ONLY, 1.0, "smooth")]
)
def test_a_lonely_motion_needs_no_warm_start(
    body: Path, wires: tuple[object, ...], follows: float, bonds: str
) -> None:
    two = bodies.oscillator()
    two["s1"] = {**two["s1"], "follows": follows}
    rows, _ = moved(bodies.scene(body, two, wires, run=run_of(1e-3, 1.0, bonds=bonds)))
    assert error(rows, 1e-3) < 2e-5


@pytest.mark.parametrize("wires", [bodies.TWO, POSITION_ONLY])
def test_where_steps_can_be_repeated_less_than_a_micrometre_is_left(
    body: Path, wires: tuple[object, ...]
) -> None:
    run = run_of(1e-3, 0.5, scheme="iterated")
    rows, outcome = moved(bodies.scene(body, bodies.oscillator(), wires, run=run))
    assert error(rows, 1e-3) < 1e-6
    assert outcome.coupling["repetitions_per_step"] < 2.5


def test_a_damped_one_is_stable_at_twenty_milliseconds(body: Path) -> None:
    """With held values it is not at 0.5 ms."""
    run = run_of(20e-3, 40.0, stop_residual=1e9)  # the ledger would stop it: it is damped too much
    rows, _ = moved(bodies.scene(body, bodies.oscillator(0.01), run=run))
    halves = np.split(bodies.energy(rows), 2)
    assert np.max(halves[1]) < 0.9 * np.max(halves[0])


@pytest.mark.parametrize(
    ("bonds", "wires"),
    [("smooth", bodies.TWO), ("contact", bodies.TWO), ("hold", bodies.TWO), ("hold", POSITION_ONLY)],
)
def test_what_the_ledger_calls_made_the_motion_has(
    body: Path, bonds: str, wires: tuple[object, ...]
) -> None:
    """And its share is of the size of what the energy lost; with held values all of it is made up."""
    run = run_of(10e-3, 10.0, bonds=bonds, stop_residual=1e9)
    rows, outcome = moved(bodies.scene(body, bodies.oscillator(), wires, run=run))
    assert outcome.made == pytest.approx(1e4 * made(rows), rel=0.05)
    if bonds == "hold":
        assert outcome.share > 1.0
    else:
        assert 1.0 < outcome.share / abs(made(rows)) < 3.0


def test_with_dampers_the_ledger_is_right_to_a_thousandth_of_the_work(body: Path) -> None:
    run = run_of(10e-3, 2.0, bonds="contact")
    scene = bodies.scene(body, bodies.oscillator(1.0), run=run)
    rows, outcome = moved(scene, (*MOTION, "s1.lost", "s2.lost"))
    really = 1e4 * made(rows[:, :4]) + float(np.sum(rows[-1, 4:]))
    assert abs(outcome.made - really) < 1e-3 * outcome.turnover
    assert outcome.warned_at is None


def test_motion_that_is_hardly_apart_teaches_the_ledger_nothing(stubborn: Path) -> None:
    """A body begins to fall with next to no speed, and its first step cannot be divided."""
    hanging = {"s1": {"k": 1e3, "kc": 1e4, "dc": 1.0, "v0": 0.1}, "s2": {"gravity": 9.81, "v0": 1e-12}}
    _, outcome = moved(bodies.scene(stubborn, hanging, run=run_of(1e-3, 0.1)))
    assert not outcome.reason
    assert outcome.share < 1e-3


def test_held_values_that_make_energy_stop_the_run(body: Path) -> None:
    run = run_of(10e-3, 10.0, scheme="hold")
    _, outcome = moved(bodies.scene(body, bodies.oscillator(), run=run))
    assert "the energy error of the coupling at s1.f on s2.f_in is" in outcome.reason
    assert "bond that crosses by hold, try --set run.bonds=smooth, or --set" in outcome.reason


def test_what_takes_steps_of_one_length_is_given_such(
    stubborn: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = bodies.scene(stubborn, bodies.oscillator(), run=run_of(1e-3, 0.5)).set({"*.isolate": False})
    steps: dict[str, set[float]] = {"s1": set(), "s2": set()}
    with opened(scene) as system:
        for name, component in system.components.items():
            step = component.step

            def noted(time: float, length: float, name: str = name, step: object = step) -> None:
                steps[name].add(length)
                step(time, length)  # type: ignore[operator]

            monkeypatch.setattr(component, "step", noted)
        simulate(scene, system)
        end = [system.value(name) for name in MOTION]
    assert {name: len(lengths) for name, lengths in steps.items()} == {"s1": 1, "s2": 1}
    assert error(np.array([[*bodies.exact_oscillator(np.array([0.0, 0.5]))[1]], end])[1:], 0.5) < 2e-5


# -- contacts -----------------------------------------------------------------------------------------


def bounced(body: Path, swing: float, **run: object) -> np.ndarray:
    """Energy made over 20 bounces, over that of the fall, at every macro step of `swing` (rad)."""
    rate, fall = 1000.0, 9.81e-3
    speed = np.sqrt(2.0 * fall)
    period = 2.0 * speed / 9.81 + (np.pi + 2.0 * np.arctan(9.81 / (rate * speed))) / rate
    scene = bodies.scene(body, bodies.bounce(rate), run=run_of(swing / rate, 20.0 * period, **run))
    rows, outcome = moved(scene, ("s2.x", "s2.v"))
    assert not outcome.reason
    x, v = rows.T
    return (0.5 * v**2 + 9.81 * x + 0.5 * (rate * np.minimum(x, 0.0)) ** 2) / fall - 1.0


def test_twenty_bounces_keep_their_energy(body: Path) -> None:
    assert np.max(np.abs(bounced(body, 0.3, bonds="contact"))) < 0.02
    assert bounced(body, 0.3, bonds="hold", stop_residual=1e9)[-1] > 10.0


def test_halving_holds_what_its_tolerance_says(body: Path) -> None:
    loose, fine = (bounced(body, 1.0, scheme="halving", tolerance=t) for t in (1e-7, 1e-8))
    assert np.max(np.abs(fine)) < 1e-3
    assert np.max(np.abs(loose)) > 3.0 * np.max(np.abs(fine))


# -- several bonds ------------------------------------------------------------------------------------


def exact_ring(count: int, closed: bool, step: float, steps: int) -> np.ndarray:
    """Positions of `count` masses of 1 kg in a row, or a ring, after each of the steps, a row each."""
    rates = np.zeros((2 * count, 2 * count))
    for i in range(count):
        rates[2 * i, 2 * i + 1] = 1.0
        rates[2 * i + 1, 2 * i] -= 10.0
    for i in range(count if closed else count - 1):
        j = (i + 1) % count
        for one, other in ((i, j), (j, i)):
            rates[2 * one + 1, 2 * one] -= 100.0
            rates[2 * one + 1, 2 * other] += 100.0
    start = np.zeros(2 * count)
    start[1::2] = 10.0 * (-1.0) ** np.arange(count)
    onward, states = expm(rates * step), [start]
    for _ in range(steps):
        states.append(onward @ states[-1])
    return np.array(states[1:])[:, ::2]


@pytest.mark.parametrize(
    ("closed", "scheme"), [(False, "interface"), (True, "interface"), (True, "iterated")]
)
def test_chains_and_rings_move_as_one_system(body: Path, closed: bool, scheme: str) -> None:
    """Named in the wrong order: what gives a force is stepped before what takes it all the same."""
    count, names = 3, [f"s{i}" for i in reversed(range(3))]
    two = {name: {"k": 10.0, "v0": 10.0 * (-1.0) ** int(name[1])} for name in names}
    wires = []
    for i in range(count if closed else count - 1):
        one, other = f"s{i}", f"s{(i + 1) % count}"
        two[one]["kc"] = 100.0
        wires += [[f"{one}.f", f"{other}.f_in"], [f"{other}.x", f"{one}.x2"], [f"{other}.v", f"{one}.v2"]]
    run = run_of(1e-3, 0.4, scheme=scheme)
    rows, outcome = moved(bodies.scene(body, two, wires, run=run), ("s0.x", "s1.x", "s2.x"))
    assert np.max(np.abs(rows - exact_ring(count, closed, 1e-3, 400))) < 2e-6
    assert ("force extrapolated" in outcome.exchange) == closed
    if not closed:
        assert outcome.exchange.endswith("order s0, s1, s2")


def supported(body: Path, step: float, **run: object) -> Scene:
    """The disk dropped on its bearing, held by a foreign body on a spring as well."""
    disk = load_scene("disk-caged-simplified")
    parts = {name: spec for name, spec in disk.components.items() if name != "amb"}
    parts["wall"] = ComponentSpec(str(body), {"m": 0.2, "k": 2e4, "kc": 5e4, "dc": 2.0, "d": 1.0})
    wires = (
        Wire("wall.f", "rotor.amb.fy"), Wire("rotor.amb.y", "wall.x2"), Wire("rotor.amb.vy", "wall.v2"),
    )  # fmt: skip
    scene = replace(disk, components=parts, attach=disk.attach[1:], connect=wires, zero=None)
    settings = {"rotor.gravity": 98.1, "bearing.clearance": 1e-4, "run.duration": 0.012}
    settings |= {"wall.isolate": False, "run.macro_step": step, **{f"run.{k}": v for k, v in run.items()}}
    return scene.set(settings)


def test_bonds_and_seats_hold_one_body_together(body: Path) -> None:
    def landed(step: float, **run: object) -> tuple[float, Outcome]:
        scene = supported(body, step, **run)
        with opened(scene, in_process=True) as system:
            outcome = simulate(scene, system)
            return system.value("bearing.contact.peak_force"), outcome

    exact, _ = landed(4e-6)
    assert exact > 500.0
    peak, outcome = landed(1e-4)
    assert peak == pytest.approx(exact, rel=1e-3)
    assert outcome.unaudited == ()
    assert outcome.warned_at is None
    assert "bearing.journal on rotor.A by interface; " in outcome.exchange
    assert "wall.f on rotor.amb.fy by smooth; " in outcome.exchange
    halved, _ = landed(1e-4, scheme="halving", tolerance=1e-9)
    assert halved == pytest.approx(exact, rel=1e-4)


def mounted(body: Path, step: float) -> Scene:
    """A disk that falls on its bearing, whose housing is the body, joined by single wires."""
    disk = load_scene("disk-caged-simplified")
    parts = {name: spec for name, spec in disk.components.items() if name not in ("amb", "housing")}
    parts["wall"] = ComponentSpec(str(body), {"m": 1e6})
    wires = (
        Wire("bearing.housing.fy", "wall.f_in"), Wire("wall.x", "bearing.housing.y"),
        Wire("wall.v", "bearing.housing.vy"),
    )  # fmt: skip
    attached = tuple(pair for pair in disk.attach if "amb" not in pair[0] and "housing" not in pair[0])
    scene = replace(disk, components=parts, attach=attached, connect=wires, zero=None)
    settings = {"rotor.gravity": 98.1, "bearing.clearance": 1e-4, "run.duration": 0.008}
    return scene.set({**settings, "wall.isolate": False, "run.macro_step": step})


def test_a_bearing_has_no_bonds(body: Path) -> None:
    """It is stepped in one; in parts its journal would be put back at each, and lose what they did."""
    scene = mounted(body, 2e-5)
    with opened(scene, in_process=True) as system:
        assert system.bonds == []
        outcome = simulate(scene, system)
        peak = system.value("bearing.contact.peak_force")
    standing = replace(scene, connect=())
    with opened(standing, in_process=True) as system:
        simulate(standing, system)
        assert peak == pytest.approx(system.value("bearing.contact.peak_force"), rel=1e-3)
    assert "bearing.housing.fy to wall.f_in, " in outcome.exchange
    declared = replace(scene, bond=(BondSpec(scene.connect[0], *scene.connect[1:]),))
    with pytest.raises(TouchdownError, match=r"bearing is a bearing, .*, and a bearing has no bonds"):
        moved(declared, ("wall.x",))


# -- what cannot be -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "run", "expected"),
    [
        (STUBBORN, {"scheme": "jacobi-lead"}, "all components at once, and s1.f on s2.f_in is a bond"),
        (STUBBORN, {"scheme": "iterated"}, r"s1 \(.*\) cannot save its state"),
        (STUBBORN, {"bonds": "smoth"}, "run.bonds = 'smoth' is not known; did you mean smooth"),
        (RIGID, {"scheme": "halving"}, r"scheme halving divides steps, and s1 \("),
        (RIGID, {"scheme": "iterated"}, r"scheme iterated divides steps, and s1 \("),
        (bodies.Kind(), {"scheme": "iterated", "bonds": "hold"}, "crosses by hold, which tells none"),
    ],
)
def test_what_a_bond_cannot_have_is_refused(
    library: Path, kind: bodies.Kind, run: dict[str, object], expected: str
) -> None:
    path = bodies.fmu(library, "refused", kind)
    with pytest.raises(TouchdownError, match=expected):
        moved(bodies.scene(path, bodies.oscillator(), run=run_of(1e-3, 0.1, **run)))


def test_iterated_repeats_for_seats_or_for_bonds(body: Path) -> None:
    with pytest.raises(TouchdownError, match=r"not for both: with bearing\.journal on rotor\.A and wall"):
        moved(supported(body, 1e-4, scheme="iterated"), ("wall.x",))


def test_steps_of_its_own_are_refused_beside_a_bond(body: Path) -> None:
    with pytest.raises(TouchdownError, match=r"remove s2\.every = 2"):
        moved(bodies.scene(body, bodies.oscillator(), run=run_of(1e-3, 0.1)).set({"s2.every": 2}))


def test_bonds_that_are_not_audited_are_told_in_their_order(body: Path) -> None:
    pairs = [(f"s{i}", f"s{i + 1}") for i in range(6)]
    wires = [w for a, b in pairs for w in ([f"{a}.f", f"{b}.f_in"], [f"{b}.x", f"{a}.x2"])]
    run = run_of(1e-3, 1e-3, scheme="jacobi-hold")
    _, outcome = moved(bodies.scene(body, {f"s{i}": {} for i in range(7)}, wires, run=run), ("s0.x",))
    why = "scheme jacobi-hold holds its values"
    assert outcome.unaudited == tuple(f"{a}.f on {b}.f_in, {why}" for a, b in pairs)
    assert outcome.exchange.endswith("s5.f on s6.f_in by hold; all components at once")


def test_a_loss_that_always_has_one_sign_is_seen(body: Path) -> None:
    """At 20 ms a part of the energy goes with every cycle, while the work of the cycles adds up."""
    run = run_of(20e-3, 40.0, stop_residual=1e9)
    rows, outcome = moved(bodies.scene(body, bodies.oscillator(), run=run))
    assert made(rows) < -0.4
    assert outcome.share == pytest.approx(abs(made(rows)), rel=0.5)
    assert "% of the energy exchanged" in outcome.warning
    assert '"run.macro_step=5000 us"' in outcome.warning  # by what was lost up to the end
