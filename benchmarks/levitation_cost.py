"""Cost of an actuator and its controller per macro step, in compiled code.

    python benchmarks/levitation_cost.py [SCENE] [--repeat 9]

Memories are kept at instants of the scene (dropped, asked for again, levitated), and both models advance
from them by 100 us, in macro steps of 20 us and of 100 us, with one sample in it. Printed are medians over
the turns of the mean over the instants, in processor time.
"""

from __future__ import annotations

import argparse
import statistics
import time as clock
from collections.abc import Callable

import numpy as np
from tried_integrators import whole

from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.interop.find_scene import find_scene

SCENE = "disk-caged-relevitated"
INSTANTS = (4e-3, 0.1, 0.21, 0.5)  # s, after the shutdown
SAMPLE = 1e-4  # s
STEPS = (2e-5, 1e-4)  # s
TIMES = 2000  # samples of a turn


def kept(scene_name: str) -> dict[str, list[InProcessComponent]]:
    """Actuator and controller at the instants."""
    found: dict[str, list[InProcessComponent]] = {}
    for instant in INSTANTS:
        scene = find_scene(scene_name)
        scene = scene.set({"run.duration": instant, "run.macro_step": SAMPLE, "run.record_every": 1000})
        system = open_system(scene, in_process=True)
        simulate(scene, system)
        for name in scene.control[0]:
            component = system.components[name]
            assert isinstance(component, InProcessComponent)
            found.setdefault(component.instance.model.name, []).append(component)
    return found


def repeater(advance: Callable, memory: np.dtype, is_controller: bool) -> Callable:
    """A kernel that advances `times` over by a sample in `count` macro steps, from a kept memory."""

    @whole
    def repeat(kept, words, work, time, count, step, times):
        m, worst = words.view(memory)[0], 0
        for _ in range(times):
            for i in range(len(words)):
                words[i] = kept[i]
            for k in range(count):
                if is_controller and k == 0:
                    m.s.seen = m.u.tick - 1.0
                worst = max(worst, advance(words, work, time + k * step, step))
        return worst

    return repeat


def main() -> None:
    """Print the costs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", nargs="?", default=SCENE)
    parser.add_argument("--repeat", type=int, default=9)
    options = parser.parse_args()
    totals = dict.fromkeys(STEPS, 0.0)
    for name, instances in kept(options.scene).items():
        model = instances[0].instance.model
        loop = repeater(model.advance, model.memory, "controller" in name)
        for step in STEPS:
            count, turns = round(SAMPLE / step), list[float]()
            for turn in range(options.repeat + 1):
                spent = 0.0
                for component in instances:
                    words, work = component.instance.words, component.instance.work
                    zero = component.instance.record["time"] + SAMPLE
                    began = clock.process_time()
                    status = loop(words.copy(), words.copy(), work.copy(), zero, count, step, TIMES)
                    spent += clock.process_time() - began
                    assert status == 0, status
                if turn:
                    turns.append(spent / (len(instances) * TIMES * count))
            totals[step] += statistics.median(turns)
            print(f"{name}: {1e6 * statistics.median(turns):.2f} us per macro step of {1e6 * step:g} us")
    for step, total in totals.items():
        print(f"both: {1e6 * total:.2f} us per macro step of {1e6 * step:g} us")


if __name__ == "__main__":
    main()
