"""An FMU of the project beside its own model: the same short run, with and without the FMU around it.

A journal is pressed from just inside the clearance into the bearing and out again, to and fro a little; a
body is pushed up and shaken; a controller sees its axes go to and fro.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Sequence

import numpy as np

from ...fmus.recipes import fmu_names, recipe
from ...modelkit.model import Model
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError
from ..components.component import NUMBERS, Component
from ..components.fmu import ArchivedFmu
from ..components.in_process import InProcessComponent
from .contract import CheckReport, port_sides

STEP, STEPS = 2e-5, 50  # s
RATE = math.pi / (STEP * STEPS)  # rad/s, of what goes to and fro once
START, DEPTH, AROUND = 1e-6, 4e-6, 1e-6  # m; how far inside the clearance, pressed in, and sideways
SPIN = 500.0  # rad/s
INVERSE_MASS = 0.5  # 1/kg, of what a bearing holds
PUSH, SHAKE = 20.0, 10.0  # N
SHOWN = (Causality.OUTPUT, Causality.LOCAL)


def model_of(component: ArchivedFmu) -> Model | None:
    """The model that an FMU of the project was made of, in its installed version; None for any other FMU.

    The name of the model and all variables identify it, not the name of the file.
    """
    description = component.description
    if component.third_party:
        return None
    known = {one.identifier: one.model for one in map(recipe, fmu_names())}
    model = known.get(description.coSimulation.modelIdentifier)
    variables = {} if model is None else InProcessComponent("model", model).variables
    declared = component.variables.items()
    names = {name for name, v in declared if v.causality is not Causality.INDEPENDENT}  # FMI 3.0's time
    return model if names <= variables.keys() else None


def compare_with_model(component: ArchivedFmu, model: Model, report: CheckReport) -> None:
    """Run both from the FMU's start values, and report where an output differs."""
    twin, variables = InProcessComponent("model", model), component.variables
    read = [n for n, v in variables.items() if v.causality in SHOWN and v.kind in NUMBERS]
    starts = {n: v.start for n, v in variables.items() if v.causality is Causality.PARAMETER and v.settable}
    settings = {name: start for name, start in starts.items() if start is not None}
    clearance = settings.get("clearance", 0.0)
    what = f"{STEPS} steps of {STEP:g} s"
    try:
        twin.set(settings)
        both = zip(_run(component, read, clearance), _run(twin, read, clearance), strict=True)
        for step, (found, expected) in enumerate(both):
            for name, value, by_model in zip(read, found, expected, strict=True):
                if value != by_model and not (math.isnan(value) and math.isnan(by_model)):
                    unit = variables[name].unit or "1"
                    report.problems.append(
                        f"{what}: {name} is {value:.17g} {unit} at t = {step * STEP:.6g} s, and "
                        f"{by_model:.17g} {unit} in the installed model; the FMU was made of other "
                        "sources, or on a system that rounds differently; build it again here"
                    )
                    return
    except TouchdownError as error:
        report.problems.append(f"{what}: {error}")
        return
    report.lines.append(f"{what}: all outputs equal the installed model's to the last bit")


def _run(component: Component, read: Sequence[str], clearance: float) -> Iterator[Sequence[float]]:
    """Outputs at the start and after each step; clearance: m, to which a journal is pressed."""
    inputs = (n for n, v in component.variables.items() if v.causality is Causality.INPUT)
    at_ports = port_sides(component)
    fed = [name for name in inputs if _drive(at_ports, name, clearance, 0.0) is not None]
    component.bind(fed, np.zeros(0), [])
    for number in range(STEPS + 1):
        time = number * STEP
        if number:
            component.step(time - STEP, STEP)
        component.inputs[:] = [_drive(at_ports, name, clearance, time) or 0.0 for name in fed]
        component.push()
        if not number:
            component.enter(0.0)
            component.exit()
        yield component.read(read)


def _drive(at_ports: Container[str], name: str, clearance: float, time: float) -> float | None:
    """What an input holds at `time` (s); None: it does not change."""
    port, _, member = name.rpartition(".")
    if member == "sensed":
        return DEPTH * math.sin(RATE * time) ** 2
    if name == "tick":
        return time / STEP
    if port not in at_ports or port.startswith("housing"):
        return None
    driven = {
        "x": AROUND * math.sin(2.0 * RATE * time),
        "y": -(clearance - START) - DEPTH * math.sin(RATE * time) ** 2,
        "vx": 2.0 * RATE * AROUND * math.cos(2.0 * RATE * time),
        "vy": -RATE * DEPTH * math.sin(2.0 * RATE * time),
        "omega": SPIN,
        "inv_m": INVERSE_MASS,
        "fx": SHAKE * math.sin(2.0 * RATE * time),
        "fy": PUSH * math.sin(RATE * time) ** 2,
    }
    return driven.get(member)
