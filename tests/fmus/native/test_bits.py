"""Native FMUs against the instance that the models run as in process: every output, as a 64-bit word.

BITS_STEPS=1000 python -m pytest -n 0 -m "native or not native" tests/fmus/native/test_bits.py

takes as many macro steps with every model and every set of parameters, which lasts several minutes.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from slave_driver import Slave

from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError, Slot
from touchdown.modelkit.variables import Causality, Scalar

Native = Callable[[str], Path]
STEP = 2e-5  # s
SETS = 10  # of parameters
ASKED = int(os.environ.get("BITS_STEPS", "0"))
CHEAP = {"housing": 1000, "rigid_rotor": 1000, "bushing": 300}  # macro steps
DEAR = dict.fromkeys(sorted(set(fmu_names()) - set(CHEAP)), 200) | {"rotor_I": 40}
CASES = [*CHEAP.items(), *(pytest.param(*case, marks=pytest.mark.native) for case in DEAR.items())]
EVERYTHING = {  # where the defaults leave most of a model out
    "mount": {
        "mass": 0.5, "spring.xx": 1e7, "spring.yy": 5e6, "spring.xy": 1e5, "damper.xx": 100.0,
        "slide[1].stiffness": 1e7, "slide[1].force": 20.0, "slide[3].stiffness": 5e6,
        "slide[3].force": 60.0, "branch[2].stiffness": 4e6, "stop.stiffness": 1e10, "stop.gap": 5e-6,
        "stop.dissipation": 0.3, "film.viscosity": 0.01,
    },
    "foundation": {
        "modes": 2, "mode[1].A.x": 0.3, "mode[1].A.y": 0.2, "mode[2].A.y": 1.0, "mode[2].B.x": 0.5,
        "mode[2].omega": 3000.0, "mode[2].damping_ratio": 0.02, "mount_A.slide[2].stiffness": 1e7,
        "mount_A.slide[2].force": 10.0, "mount_B.branch[1].stiffness": 1e7, "mount_B.film.viscosity": 0.01,
        "mount_B.stop.gap": 1e-7, "mount_B.stop.stiffness": 1e10,
    },
    "angular_simplified": {
        "balls.contact_angle": 0.4, "balls.rows": 2, "balls.play": 0.0, "arrangement": 1, "preload": 100.0,
        "row_distance": 0.01, "shoulder.gap_minus": 1e-4, "shoulder.gap_plus": 2e-4,
    },
    "landing_sleeve": {"shoulder.gap_minus": 1e-4, "shoulder.gap_plus": 2e-4},
}  # fmt: skip
WHOLE = {"modes": (2, 5, 10), "residual": (0, 1)}  # that rotors hold constants for


class InProcess:
    """An instance, driven as an FMU is."""

    def __init__(self, name: str) -> None:
        self.instance = Instance(recipe(name).model)
        self.slots = {slot.variable.name: slot for slot in self.instance.slots}

    def store(self, slot: Slot) -> memoryview:
        """The words of its kind."""
        real = slot.variable.spec.kind is Scalar.REAL
        return self.instance.reals if real else self.instance.integers

    def put(self, values: dict[str, float]) -> None:
        for name, value in values.items():
            self.store(self.slots[name])[self.slots[name].index] = value

    def outputs(self) -> np.ndarray:
        found = [s for s in self.instance.slots if s.causality is Causality.OUTPUT]
        return np.array([float(self.store(s)[s.index]) for s in found])


class Linked:
    """A native FMU, its values exchanged as vectors."""

    def __init__(self, folder: Path, slots: Sequence[Slot]) -> None:
        self.slave = Slave(folder)
        self.by_name = {slot.variable.name: slot for slot in slots}
        outputs = [slot for slot in slots if slot.causality is Causality.OUTPUT]
        self.real = np.array([slot.variable.spec.kind is Scalar.REAL for slot in outputs])
        self.references = [slot.index for slot in outputs]

    def put(self, values: dict[str, float]) -> None:
        for kind, call in (
            (Scalar.REAL, self.slave.fmu.setReal),
            (Scalar.INTEGER, self.slave.fmu.setInteger),
        ):
            chosen = {n: v for n, v in values.items() if self.by_name[n].variable.spec.kind is kind}
            if chosen:
                call([self.by_name[n].index for n in chosen], list(chosen.values()))

    def outputs(self) -> np.ndarray:
        found = np.zeros(len(self.references))
        for real, call in ((True, self.slave.fmu.getReal), (False, self.slave.fmu.getInteger)):
            chosen = np.flatnonzero(self.real == real)
            if len(chosen):
                found[chosen] = call([self.references[i] for i in chosen])
        return found


def starts(name: str, parameters: dict[str, float]) -> bool:
    """Whether a model takes them together."""
    one = InProcess(name)
    one.put(parameters)
    try:
        one.instance.start(0.0)
    except ModelError:
        return False
    return True


def parameter_sets(name: str) -> list[dict[str, float]]:
    """The defaults or everything, then values near the defaults that go together; whole numbers, too."""
    first = EVERYTHING.get(name, {})
    return [first, *islice((one for one in drawn(name) if starts(name, one)), SETS - 1)]


def drawn(name: str) -> Iterator[dict[str, float]]:
    """Values near the defaults, within their bounds."""
    generator, slots = np.random.default_rng(15), Instance(recipe(name).model).slots
    while True:
        chosen: dict[str, float] = {}
        for slot in slots:
            v = slot.variable
            if slot.causality is Causality.PARAMETER and v.spec.kind is Scalar.REAL:
                value = v.default * float(generator.uniform(0.9, 1.1))
                chosen[v.name] = v.default if v.problem(value) else value
            elif v.name in WHOLE:
                chosen[v.name] = int(generator.choice(WHOLE[v.name]))
        yield chosen


def inputs(slots: Sequence[Slot], k: int) -> dict[str, float]:
    """Of macro step `k`: a journal that falls, hits and whirls in a bearing that shakes; rough loads."""
    generator, t = np.random.default_rng(k), k * STEP
    by_tail = {
        "x": 1.6e-4 * math.sin(400 * t),
        "y": -0.2e-3 - 1.4e-4 * math.sin(300 * t),
        "z": -3e-4 * math.sin(200 * t),
        "vz": -0.06 * math.cos(200 * t),
        "inv_m_z": 0.6,
        "rx": 2e-4 * math.sin(150 * t),
        "wy": -0.03 * math.cos(150 * t),
        "inv_I_t": 300.0,
        "inv_mI": 12.0,
        "gyro": 1200.0,
        "vx": 0.064 * math.cos(400 * t),
        "vy": -0.042 * math.cos(300 * t),
        "ay_free": -9.81,
        "inv_m": 0.6,
        "omega": 942.0 - 1e3 * t,
        "inv_I": 2000.0,
    }
    sizes = {"fx": 100.0, "fy": 100.0, "mz": 0.1, "dfx": 1e5, "dfy": 1e5, "dmz": 1e2}
    found: dict[str, float] = {}
    for slot in slots:
        name = slot.variable.name
        if slot.causality is not Causality.INPUT or ".mode[" in name:
            continue
        port, _, tail = name.rpartition(".")
        if port == "journal":
            found[name] = by_tail.get(tail, 0.0)
        elif tail in sizes:
            found[name] = sizes[tail] * float(generator.standard_normal())
        elif name == "tick":
            found[name] = float(k)
        elif tail == "sensed":
            found[name] = 1e-4 * float(generator.standard_normal())
        elif port == "housing":
            calm = {"inv_m": 0.2, "k_over_m": 5e7, "c_over_m": 500.0}
            found[name] = calm.get(tail.removesuffix("_z"), 1e-6 * float(generator.standard_normal()))
    return found


@pytest.mark.parametrize(("fmu", "steps"), CASES)
def test_every_output_is_equal_to_the_last_bit(fmu: str, steps: int, native: Native):
    """Ten sets of parameters; the first for all the steps, the others for a tenth of them, unless asked."""
    model_slots = Instance(recipe(fmu).model).slots
    moved = 0
    for number, parameters in enumerate(parameter_sets(fmu)):
        here, there = InProcess(fmu), Linked(native(fmu), model_slots)
        for one in (here, there):
            one.put({**parameters, **inputs(model_slots, 0)})
        here.instance.start(0.0)
        there.slave.start()
        before = here.outputs()
        for k in range(ASKED or (steps if number == 0 else steps // 10)):
            assert np.array_equal(here.outputs().view("u8"), there.outputs().view("u8")), (parameters, k)
            for one in (here, there):
                one.put(inputs(model_slots, k))
            here.instance.step(k * STEP, STEP)
            there.slave.fmu.doStep(k * STEP, STEP)
        moved += not np.array_equal(before, here.outputs())
        there.slave.free()
    assert moved == SETS
