"""What a crossing of the FMI costs: time per FMU and macro step beyond its kernel.

Runs a drop through FMUs and in process, in pairs, and times in the same run, per component, what the
master spends on it (inputs, step, outputs) and what the compiled kernel alone takes. The last column is the
same with this FMU, and no other, in a process of its own, as third-party FMUs are (`isolate`).

The last lines set the whole run beside its kernels' own time, which one compiled program would need.

    python benchmarks/fmu_overhead.py [--scene disk-caged-simplified] [--macro-step "20 us"]
"""

from __future__ import annotations

import argparse
import statistics
import time as clock
from dataclasses import replace
from unittest import mock

from touchdown.fmus.recipes import Recipe
from touchdown.master.components import loading
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.components.loading import built, locate_fmu
from touchdown.master.coupling.simulation import open_system, opened, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene


def kernel_times(scene: Scene) -> dict[str, float]:
    """us per macro step in the compiled kernel, per component, for the run's own motion."""
    system = open_system(scene, in_process=True)
    spent = dict.fromkeys(system.components, 0.0)
    for name, component in system.components.items():
        assert isinstance(component, InProcessComponent)
        instance = component.instance

        def step(time: float, size: float, instance=instance, name=name) -> None:
            began = clock.perf_counter()
            instance.advance(instance.words, instance.work, time, size)
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


def isolated_times(scene: Scene) -> dict[str, float]:
    """The same of each FMU when it, and no other, is in a process of its own."""
    found: dict[str, float] = {}
    for name, spec in scene.components.items():
        recipe = locate_fmu(spec.fmu, scene.folder)
        assert isinstance(recipe, Recipe)
        of_others = {**scene.components, name: replace(spec, fmu=str(built(recipe)))}
        with mock.patch.object(loading, "is_sealed", return_value=False):
            found[name] = fmu_times(replace(scene, components=of_others))[name]
    return found


def _time_calls(component: object, call: str, spent: dict[str, float], name: str) -> None:
    original = getattr(component, call)
    first = call == "step"

    def timed(*arguments: float) -> None:
        nonlocal first
        began = clock.perf_counter()
        original(*arguments)
        spent[name] += clock.perf_counter() - began
        if first:  # up to here, a process of its own has loaded its machine code
            spent[name], first = 0.0, False

    setattr(component, call, timed)


def _per_step(scene: Scene, system: System, spent: dict[str, float]) -> dict[str, float]:
    outcome = simulate(scene, system)
    system.close()
    return {name: 1e6 * seconds / outcome.steps for name, seconds in spent.items()}


def whole_run(scene: Scene) -> float:
    """us per macro step of the whole run through FMUs, nothing recorded."""
    with opened(scene) as system:
        outcome = simulate(scene, system)
        return 1e6 * outcome.wall_time / outcome.steps


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scene", default="disk-caged-simplified")
    parser.add_argument("--macro-step", help="default: the scene's")
    parser.add_argument("--duration", type=float, default=0.3, help="s")
    parser.add_argument("--pairs", type=int, default=5)
    options = parser.parse_args()
    scene = load_scene(options.scene).set({"run.duration": options.duration})
    scene = scene.set({"run.stop_residual": 1e9})
    if options.macro_step is not None:
        scene = scene.set({"run.macro_step": options.macro_step})
    kernel_times(scene), fmu_times(scene)  # compile and warm up
    runs = [
        (kernel_times(scene), fmu_times(scene), whole_run(scene), isolated_times(scene))
        for _ in range(options.pairs)
    ]
    step = scene.run.macro_step
    print(f"{scene.name}, macro step {1e6 * step:g} us, median of {options.pairs}")
    print(f"{'component':<12}{'kernel [us]':>13}{'FMU [us]':>13}{'beyond [us]':>13}{'isolated [us]':>15}")
    for name in runs[0][0]:
        kernel = statistics.median(k[name] for k, _, _, _ in runs)
        fmu = statistics.median(f[name] for _, f, _, _ in runs)
        beyond = statistics.median(f[name] - k[name] for k, f, _, _ in runs)
        isolated = statistics.median(i[name] for _, _, _, i in runs)
        print(f"{name:<12}{kernel:>13.2f}{fmu:>13.2f}{beyond:>13.2f}{isolated:>15.2f}")
    kernels = statistics.median(sum(k.values()) for k, _, _, _ in runs)
    whole = statistics.median(w for _, _, w, _ in runs)
    ratio = statistics.median(w / sum(k.values()) for k, _, w, _ in runs)
    print(f"whole run: {whole:.1f} us per macro step, its kernels {kernels:.1f} us: {ratio:.2f} times;")
    print(f"{1e-6 * whole / step:.2f} s per simulated s, the kernels alone {1e-6 * kernels / step:.2f}")


if __name__ == "__main__":
    main()
