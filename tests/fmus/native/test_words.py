"""A native FMU behaves as the one in Python does, and refuses in the same words."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from slave_answers import judge

from touchdown.fmus.recipes import fmu_names

Alone = Callable[..., subprocess.CompletedProcess[str]]
Native = Callable[[str], Path]
CHEAP = ("bushing",)
SAME_CODE = "rotor_II"  # the code of rotor_I on other data
DEAR = [
    pytest.param(name, marks=pytest.mark.native) for name in fmu_names() if name not in (*CHEAP, SAME_CODE)
]

SAID = """
import json, math
from slave_driver import STEP, TOUCHING, Slave
from slave_questions import out_of_bounds

folder, other = sys.argv[1:]
found = []

def told(label, slave, call=lambda: None, *arguments):
    # what FMUs in Python add to it, and put around it, is their library's
    refused = slave.refuses(call, *arguments)
    said = [message.split("RuntimeError('")[-1].removesuffix("')") for message in slave.messages[:1]]
    found.append([label, refused, said])
    slave.free()

def set_and_start(values, at=0.0):
    slave = Slave(folder)
    slave.set(values)
    slave.fmu.setupExperiment(startTime=at)
    slave.fmu.enterInitializationMode()
    told(["start", str(values)], slave, slave.fmu.exitInitializationMode)

probe = Slave(folder)
real = [n for n in probe.named("parameter") if probe.variables[n].type == "Real"]
for name, value in out_of_bounds(probe):
    set_and_start({name: value})
for name in real:
    for value in (1e308, -1e308, 5e-324):
        set_and_start({name: value})
for name in probe.named("input"):
    set_and_start({name: math.nan})
    slave = Slave(folder).start(TOUCHING)
    slave.set({name: math.nan})
    told(["input", name], slave, slave.fmu.doStep, 0.0, STEP)
for values in json.loads('[{"modes": 1}, {"modes": 999}, {"stress.node": 60}]'):
    if set(values) <= set(probe.variables):
        set_and_start(values)
for time, step in ((0, 0), (0, -1e-5), (0, math.nan), (0, math.inf), (math.nan, 1e-5), (0.123456789, 1e-5)):
    slave = Slave(folder).start(TOUCHING)
    told(["step", time, step], slave, slave.fmu.doStep, time, step)

references = sorted({v.valueReference for v in probe.variables.values()})
mixed = [references[0], references[-1], 2**32 - 1, references[-1] + 1, references[0]]
for early in (True, False):
    for doing in ("getReal", "getInteger", "setReal", "setInteger"):
        slave = Slave(folder) if early else Slave(folder).start(TOUCHING)
        values = [[1] * len(mixed)] if doing.startswith("set") else []
        told([doing, early], slave, getattr(slave.fmu, doing), mixed, *values)

foreign = Slave(other).start()
state = foreign.fmu.serializeFMUstate(foreign.fmu.getFMUstate())
slave = Slave(folder).start(TOUCHING)
told("foreign state", slave, slave.fmu.deSerializeFMUstate, state)
slave = Slave(folder).start(TOUCHING)
good, failed = slave.fmu.getFMUstate(), None
slave.refuses(slave.fmu.doStep, 0.0, -1.0)
failed = slave.fmu.getFMUstate()
slave.fmu.setFMUstate(good)
slave.fmu.doStep(0.0, STEP)
slave.fmu.setFMUstate(failed)
slave.messages.clear()
told("failed state", slave, slave.fmu.doStep, 0.0, STEP)
print(json.dumps(found))
"""
ASKED = "from slave_questions import ask; ask(*sys.argv[1:])"


def answered(done: subprocess.CompletedProcess[str]) -> Any:
    """What a script printed last; absurd values may make numpy warn."""
    assert done.returncode == 0, f"exit status {done.returncode}\n{done.stdout}\n{done.stderr}"
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize("fmu", [*CHEAP, *DEAR])
def test_it_refuses_in_the_words_of_the_one_in_python(
    fmu: str, alone: Alone, native: Native, unpacked: Mapping[str, Path]
):
    other = "housing" if fmu != "housing" else "rigid_rotor"
    in_python = answered(alone(SAID, unpacked[fmu], unpacked[other]))
    found = answered(alone(SAID, native(fmu), native(other)))
    assert len(found) == len(in_python) > 30
    assert sum(refused for _, refused, _ in found) > 20
    assert [pair for pair in zip(found, in_python, strict=True) if pair[0] != pair[1]] == []


@pytest.mark.parametrize("fmu", [*CHEAP, *DEAR])
def test_it_answers_all_questions_as_it_should(fmu: str, alone: Alone, native: Native):
    """The questions that FMUs in Python are asked, in `slave_questions`."""
    found = answered(alone(ASKED, native(fmu), native("housing" if fmu != "housing" else "rigid_rotor")))
    judge(found)
