"""What a crossing of the FMI costs: time per FMU and macro step beyond its kernel.

Runs a drop through FMUs and in process, in pairs, and times in the same run, per component, what the
master spends on it (inputs, step, outputs) and what the compiled kernel alone takes.

    python benchmarks/fmu_overhead.py [--scene disk-caged-simplified] [--duration 0.3] [--pairs 5]
"""

from __future__ import annotations

import argparse
import statistics
import time as clock

from master.scene import Scene, load
from master.simulation import open_system, simulate
from master.system import System
from master.twin import TwinComponent


def kernel_times(scene: Scene) -> dict[str, float]:
    """us per macro step in the compiled kernel, per component, for the run's own motion."""
    system = open_system(scene, in_process=True)
    spent = dict.fromkeys(system.components, 0.0)
    for name, component in system.components.items():
        assert isinstance(component, TwinComponent)
        instance = component.instance

        def step(time: float, size: float, instance=instance, name=name) -> None:
            began = clock.perf_counter()
            instance.model.advance(instance.words, instance.work, time, size)
            spent[name] += clock.perf_counter() - began

        component.step = step  # type: ignore[method-assign]
    return _per_step(scene, system, spent)


def fmu_times(scene: Scene) -> dict[str, float]:
    """us per macro step that the master spends on each FMU: inputs, step, outputs."""
    system = open_system(scene)
    spent = dict.fromkeys(system.components, 0.0)
    for name, component in system.components.items():
        for call in ("push", "step", "pull"):
            _time_calls(component, call, spent, name)
    return _per_step(scene, system, spent)


def _time_calls(component: object, call: str, spent: dict[str, float], name: str) -> None:
    original = getattr(component, call)

    def timed(*arguments: float) -> None:
        began = clock.perf_counter()
        original(*arguments)
        spent[name] += clock.perf_counter() - began

    setattr(component, call, timed)


def _per_step(scene: Scene, system: System, spent: dict[str, float]) -> dict[str, float]:
    outcome = simulate(scene, system)
    system.close()
    return {name: 1e6 * seconds / outcome.steps for name, seconds in spent.items()}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", default="disk-caged-simplified")
    parser.add_argument("--duration", type=float, default=0.3, help="s")
    parser.add_argument("--pairs", type=int, default=5)
    options = parser.parse_args()
    scene = load(options.scene).with_setting("run.duration", options.duration)
    kernel_times(scene), fmu_times(scene)  # compile and warm up
    pairs = [(kernel_times(scene), fmu_times(scene)) for _ in range(options.pairs)]
    print(f"{scene.name}, macro step {scene.run.macro_step:g} s, median of {options.pairs} pairs")
    print(f"{'component':<12}{'kernel [us]':>13}{'FMU [us]':>13}{'beyond [us]':>13}")
    for name in pairs[0][0]:
        kernel = statistics.median(k[name] for k, _ in pairs)
        fmu = statistics.median(f[name] for _, f in pairs)
        beyond = statistics.median(f[name] - k[name] for k, f in pairs)
        print(f"{name:<12}{kernel:>13.2f}{fmu:>13.2f}{beyond:>13.2f}")


if __name__ == "__main__":
    main()
