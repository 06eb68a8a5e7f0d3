"""Co-simulation masters on the same FMUs of others: error, energy, longest stable step, calls.

The bodies of tests/master/coupling/bonds, compiled here: two masses of 1 kg on springs of 10, 100 and
1000 N/m, shot at each other with 100 m/s, undamped or with dampers of 0.01 N s/m; a quarter car (400 and
40 kg) over a step of the road of 0.1 m; a ball on an undamped one-sided spring. Every scheme of this
master against the exact motion.

    python benchmarks/masters.py [--part oscillator,stable,bounce,car]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.extend(
    str(Path(__file__).resolve().parents[1] / part)
    for part in ("tests/support", "tests/master/coupling/bonds", "tests/master/interop/peers")
)

import bodies

from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.scene.scene import Scene

Step = Callable[[float, float], None]
POSITION_ONLY, VELOCITY_ONLY = bodies.TWO[:2], bodies.TWO[::2]
DAMPING = 0.01  # N s/m
FULL = 1e4  # J, of the oscillator at the begin


@dataclass(frozen=True)
class Way:
    """A scheme, as [run] of a scene has it."""

    title: str
    run: Mapping[str, object]


WAYS = (
    Way("hold", {"scheme": "hold", "stop_residual": 1e9}),
    Way("smooth", {"bonds": "smooth", "stop_residual": 1e9}),
    Way("contact", {"bonds": "contact", "stop_residual": 1e9}),
    Way("iterated", {"scheme": "iterated"}),
    Way("halving, 1e-8 m", {"scheme": "halving", "tolerance": 1e-8}),
)


@dataclass
class Ran:
    """What a run gave."""

    rows: np.ndarray  # of what was watched, at the end of every macro step
    outcome: Outcome
    calls: float  # doSteps per macro step


def run(scene: Scene, watched: Sequence[str]) -> Ran:
    """A run that counts its steps; those that were taken back count, too."""
    rows: list[list[float]] = []
    calls = 0
    with opened(scene) as system:
        for component in system.components.values():

            def counted(
                time: float, step: float, take: Callable[[float, float], None] = component.step
            ) -> None:
                nonlocal calls
                calls += 1
                take(time, step)

            component.step = counted  # type: ignore[method-assign]
        watch = EveryStep(lambda now: rows.append([system.value(name) for name in watched]))
        outcome = simulate(scene, system, observers=[watch])
    return Ran(np.array(rows), outcome, calls / max(outcome.steps, 1))


def swung(fmu: Path, way: Way, step: float, duration: float, damping: float = 0.0, alone: str = "") -> Ran:
    """The oscillator; `alone`: the one motion that comes back."""
    two = bodies.oscillator(damping)
    two["s1"] = {**two["s1"], "follows": float(alone == "velocity")}
    wires = {"position": POSITION_ONLY, "velocity": VELOCITY_ONLY}.get(alone, bodies.TWO)
    table = {"macro_step": step, "duration": duration, **way.run}
    return run(bodies.scene(fmu, two, wires, run=table), ("s1.x", "s1.v", "s2.x", "s2.v"))


def error(ran: Ran, step: float) -> float:
    """Largest of the undamped oscillator's positions (m); infinite where the run ended early."""
    if ran.outcome.reason:
        return float("inf")
    exact = bodies.exact_oscillator(np.arange(len(ran.rows) + 1) * step)[1:]
    return float(np.max(np.abs(ran.rows - exact)[:, ::2]))


def oscillator(fmu: Path) -> None:
    """Error and energy over 10 s."""
    print(
        "\ntwo masses, undamped, 10 s: largest error (m), energy made, what the ledger calls made; doSteps"
    )
    for step in (1e-2, 1e-3):
        for way in WAYS:
            for alone in ("", "position", "velocity"):
                if alone and way.title == "hold":
                    continue
                ran = swung(fmu, way, step, 10.0, alone=alone)
                energy = bodies.energy(ran.rows[-1:])[0] / FULL - 1.0
                title = f"{way.title}{f', {alone} only' * bool(alone)}"
                print(
                    f"{1e3 * step:5g} ms  {title:32} {error(ran, step):9.1e} {energy:10.1e} "
                    f"{ran.outcome.made / FULL:10.1e} {ran.calls:6.1f}",
                    flush=True,
                )


def stable(fmu: Path) -> None:
    """The longest macro step at which the damped oscillator comes to rest."""
    print("\ntwo masses, damped: longest stable step (ms)")
    for way in WAYS[:4]:
        low, high = 1e-4, 0.3
        while high / low > 1.1:
            middle = (low * high) ** 0.5
            low, high = (middle, high) if rests(fmu, way, middle) else (low, middle)
        print(f"{way.title:20} {1e3 * low:6.2g}", flush=True)


def rests(fmu: Path, way: Way, step: float) -> bool:
    """Whether its energy falls over 2000 macro steps, or over 40 s."""
    ran = swung(fmu, way, step, max(2000.0 * step, 40.0), DAMPING)
    if ran.outcome.reason or not np.all(np.isfinite(ran.rows)):
        return False
    energy = bodies.energy(ran.rows)
    return float(np.max(energy[len(energy) // 2 :])) < float(np.max(energy[: len(energy) // 2]))


def bounce(fmu: Path) -> None:
    """Energy made over twenty bounces."""
    rate, fall = 1000.0, 9.81e-3
    speed = (2.0 * fall) ** 0.5
    period = 2.0 * speed / 9.81 + (np.pi + 2.0 * np.arctan(9.81 / (rate * speed))) / rate
    print(
        "\n20 bounces, by swing per macro step (rad): largest change of energy, called made; share; doSteps"
    )
    for swing in (0.03, 0.1, 0.3, 1.0):
        for way in WAYS:
            table = {"macro_step": swing / rate, "duration": 20.0 * period, **way.run}
            ran = run(bodies.scene(fmu, bodies.bounce(rate), run=table), ("s2.x", "s2.v"))
            x, v = ran.rows.T
            energy = (0.5 * v**2 + 9.81 * x + 0.5 * (rate * np.minimum(x, 0.0)) ** 2) / fall - 1.0
            print(
                f"{swing:5g}  {way.title:20} {np.max(np.abs(energy)):9.1e} {ran.outcome.made / fall:9.1e} "
                f"{ran.outcome.share:9.1e} {ran.calls:6.1f}",
                flush=True,
            )


def car(fmu: Path) -> None:
    """Error by doSteps."""
    print("\nquarter car, 2 s: largest error of chassis and wheel (mm) by doSteps in all")
    for way in WAYS:
        for step in (8e-3, 4e-3, 2e-3, 1e-3, 5e-4):
            table = {"macro_step": step, "duration": 2.0, **way.run}
            ran = run(bodies.scene(fmu, bodies.CAR, bodies.CAR_WIRES, run=table), ("chassis.x", "wheel.x"))
            exact = bodies.exact_car(np.arange(len(ran.rows) + 1) * step)[1:, ::2]
            off = 1e3 * np.max(np.abs(ran.rows - exact), axis=0)
            calls = ran.calls * len(ran.rows)
            title = f"{way.title:20} {1e3 * step:5g} ms"
            print(f"{title} {calls:8.0f} {off[0]:9.2g} {off[1]:9.2g}", flush=True)


PARTS = {"oscillator": oscillator, "stable": stable, "bounce": bounce, "car": car}


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--part", default=",".join(PARTS), help="of " + ", ".join(PARTS))
    chosen = parser.parse_args().part.split(",")
    with tempfile.TemporaryDirectory() as folder:
        fmu = bodies.fmu(bodies.compiled(Path(folder)))
        for name in chosen:
            PARTS[name](fmu)


if __name__ == "__main__":
    main()
