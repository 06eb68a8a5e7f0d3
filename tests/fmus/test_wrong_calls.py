"""What FMUs answer to calls that no host should make: fmi2Error, in the call itself, and why in the log."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

Alone = Callable[..., subprocess.CompletedProcess[str]]
Native = Callable[[str], Path]

DISCARD, ERROR = 2, 3  # fmi2Status

CALLS = """
import json, math
from slave_driver import STEP, TOUCHING, Slave

folder, other = sys.argv[1:]
REAL, WHOLE, INPUT, OUTPUT = "clearance", "friction.kind", "journal.y", "contact.force"
UNKNOWN = 123456789

def status(call, *arguments):
    try:
        call(*arguments)
    except Exception as error:
        return error.status
    return 0

def new():
    return Slave(folder)

def set_up():
    slave = new()
    slave.fmu.setupExperiment(startTime=0.0)
    return slave

def initialising(name=REAL, value=3e-4):
    slave = new()
    slave.set({name: value})
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    return slave

def running():
    slave = new().start()
    slave.fmu.doStep(0.0, STEP)
    return slave

def badly():
    return initialising(REAL, -1)

def chosen():
    return initialising(WHOLE, 99)

def fed(value):
    slave = running()
    slave.set({INPUT: value})
    return slave

def bounded():
    slave = new()
    slave.fmu.setupExperiment(startTime=0.0, stopTime=1.5 * STEP)
    slave.fmu.enterInitializationMode()
    slave.fmu.exitInitializationMode()
    slave.fmu.doStep(0.0, STEP)
    return slave

def restored(slave):
    other = new().start()
    other.fmu.setFMUstate(other.fmu.deSerializeFMUstate(bytes_of(slave)))
    return other

def failed():
    slave = running()
    status(slave.fmu.doStep, STEP, -1.0)
    return slave

def ended():
    slave = running()
    slave.fmu.terminate()
    return slave

def of(slave, name):
    return [slave.variables[name].valueReference]

def bytes_of(slave):
    return slave.fmu.serializeFMUstate(slave.fmu.getFMUstate())

def strange():
    return bytes_of(Slave(other).start())

def changed(slave):
    found = bytearray(bytes_of(slave))
    found[len(found) // 2] ^= 1
    return bytes(found)

WRONG = {
    "read an output before initialisation": (new, lambda s: s.fmu.getReal(of(s, OUTPUT))),
    "read an unknown reference": (new, lambda s: s.fmu.getReal([UNKNOWN])),
    "read an integer as real": (new, lambda s: s.fmu.getReal(of(s, WHOLE))),
    "read a real as integer": (new, lambda s: s.fmu.getInteger(of(s, REAL))),
    "set an unknown reference": (new, lambda s: s.fmu.setReal([UNKNOWN], [1.0])),
    "set a real as boolean": (new, lambda s: s.fmu.setBoolean(of(s, REAL), [1])),
    "set an output": (new, lambda s: s.fmu.setReal(of(s, OUTPUT), [1.0])),
    "set up at no time": (new, lambda s: s.fmu.setupExperiment(startTime=math.nan)),
    "set up to stop at the start": (new, lambda s: s.fmu.setupExperiment(startTime=1.0, stopTime=1.0)),
    "enter initialisation without an experiment": (new, lambda s: s.fmu.enterInitializationMode()),
    "end a new one": (new, lambda s: s.fmu.terminate()),
    "end one that was set up": (set_up, lambda s: s.fmu.terminate()),
    "end while initialising": (initialising, lambda s: s.fmu.terminate()),
    "end twice": (ended, lambda s: s.fmu.terminate()),
    "complete initialisation that was not entered": (new, lambda s: s.fmu.exitInitializationMode()),
    "step a new one": (new, lambda s: s.fmu.doStep(0.0, STEP)),
    "set up while initialising": (initialising, lambda s: s.fmu.setupExperiment(startTime=0.0)),
    "enter initialisation twice": (initialising, lambda s: s.fmu.enterInitializationMode()),
    "step while initialising": (initialising, lambda s: s.fmu.doStep(0.0, STEP)),
    "read what a bad parameter makes": (badly, lambda s: s.fmu.getReal(of(s, OUTPUT))),
    "complete with a bad parameter": (badly, lambda s: s.fmu.exitInitializationMode()),
    "complete with a bad integer": (chosen, lambda s: s.fmu.exitInitializationMode()),
    "complete with an input that is no number": (
        lambda: initialising(INPUT, math.nan), lambda s: s.fmu.exitInitializationMode()),
    "set up when running": (running, lambda s: s.fmu.setupExperiment(startTime=0.0)),
    "complete initialisation twice": (running, lambda s: s.fmu.exitInitializationMode()),
    "set a fixed parameter": (running, lambda s: s.fmu.setReal(of(s, REAL), [1e-4])),
    "set an output when running": (running, lambda s: s.fmu.setReal(of(s, OUTPUT), [1.0])),
    "read an unknown reference when running": (running, lambda s: s.fmu.getInteger([UNKNOWN])),
    "set one of two wrongly": (running, lambda s: s.fmu.setReal(of(s, INPUT) + of(s, REAL), [0, 1])),
    "step back": (running, lambda s: s.fmu.doStep(0.0, STEP)),
    "leave a gap": (running, lambda s: s.fmu.doStep(3 * STEP, STEP)),
    "step past the stop time": (bounded, lambda s: s.fmu.doStep(STEP, STEP)),
    "step past a restored stop time": (
        lambda: restored(bounded()), lambda s: s.fmu.doStep(STEP, STEP)),
    "step by nothing": (running, lambda s: s.fmu.doStep(STEP, 0.0)),
    "step by less than nothing": (running, lambda s: s.fmu.doStep(STEP, -STEP)),
    "step with an input that is no number": (lambda: fed(math.nan), lambda s: s.fmu.doStep(STEP, STEP)),
    "step one that failed": (failed, lambda s: s.fmu.doStep(STEP, STEP)),
    "step one that ended": (ended, lambda s: s.fmu.doStep(STEP, STEP)),
    "cancel a step": (running, lambda s: s.fmu.cancelStep()),
    "set an input's rate": (running, lambda s: s.fmu.setRealInputDerivatives(of(s, INPUT), [1], [0])),
    "take another FMU's bytes": (running, lambda s: s.fmu.deSerializeFMUstate(strange())),
    "take bytes that were cut": (running, lambda s: s.fmu.deSerializeFMUstate(bytes_of(s)[:-1])),
    "take bytes that were changed": (running, lambda s: s.fmu.deSerializeFMUstate(changed(s))),
}

found = {}
for name, (prepared, call) in WRONG.items():
    slave = prepared()
    slave.messages.clear()
    answer = status(call, slave)
    said = slave.said
    slave.fmu.reset()
    again = slave.start().run(0, 1) != []
    slave.free()
    found[name] = [answer, said, again, None in slave.categories]
print(json.dumps(found))
"""

TOO_LONG = """
slave = Slave(sys.argv[1]).start({**TOUCHING, "contact.stiffness": 1e12})
state = slave.fmu.getFMUstate()
answers = []
for length in (1e3, STEP):
    try:
        slave.fmu.doStep(0.0, length)
        answers.append(0)
    except Exception as error:
        answers.append(error.status)
    slave.fmu.setFMUstate(state)
print(json.dumps([answers, slave.said]))
"""

REASONS = {  # what the log says of some
    "read an output before initialisation": "contact.force cannot be read before initialisation",
    "read an integer as real": "friction.kind cannot be read as real",
    "set a real as boolean": "clearance cannot be set as boolean",
    "read an unknown reference": "value reference 123456789",
    "complete with a bad parameter": "clearance = -1 m must be above 0 m",
    "read what a bad parameter makes": "clearance = -1 m must be above 0 m",
    "set a fixed parameter": "clearance cannot be set as real now; parameters that are not",
    "step back": "the last step ended at 2e-05 s",
    "set up to stop at the start": "the stop time is 1 s; it must lie after the start time, 1 s",
    "step past the stop time": "the stop time is 3e-05 s",
    "step past a restored stop time": "the stop time is 3e-05 s",
    "enter initialisation without an experiment": "must be set up before initialisation is entered",
    "end twice": "can be ended once, after initialisation",
    "step one that failed": "stopped before: cannot step",
    "take bytes that were changed": "not one of this FMU, or was changed",
}


NAMES = """
made = []
for name in ("", " \\t", "a b"):
    try:
        made.append(bool(Slave(sys.argv[1], name)))
    except Exception as error:
        made.append(str(error))
print(json.dumps(made))
"""


def answered(done: subprocess.CompletedProcess[str]) -> list[Any]:
    """What a script printed, line by line; its process must have ended well."""
    assert done.returncode == 0, f"exit status {done.returncode}\n{done.stdout}\n{done.stderr}"
    return [json.loads(line) for line in done.stdout.splitlines()]


@pytest.fixture(scope="module", params=["python", "native"])
def found(request: pytest.FixtureRequest, unpacked: Mapping[str, Path], alone: Alone) -> list[Any]:
    """Answers of a bearing of either kind: to wrong calls, to a step that is too long, to names."""
    make = unpacked.__getitem__ if request.param == "python" else request.getfixturevalue("native")
    return answered(alone(f"{CALLS}\n{TOO_LONG}\n{NAMES}", make("bushing"), make("housing")))


def test_a_wrong_call_is_answered_by_an_error(found: list[Any]):
    """With its reason; and the instance can be reset, runs and is freed."""
    calls = found[0]
    assert len(calls) > 30
    assert {name: status for name, (status, _, _, _) in calls.items() if status != ERROR} == {}
    assert [name for name, (_, said, _, _) in calls.items() if not said] == []
    assert {name: calls[name][1] for name, part in REASONS.items() if part not in calls[name][1]} == {}
    assert [name for name, (_, _, again, _) in calls.items() if not again] == []
    assert [name for name, (_, _, _, uncategorised) in calls.items() if uncategorised] == []


def test_only_a_step_that_is_too_long_is_discarded(found: list[Any]):
    """From the state before, a smaller one is taken."""
    answers, said = found[1]
    assert answers == [DISCARD, 0]
    assert "take a smaller macro step" in said


def test_an_instance_needs_a_name(found: list[Any]):
    assert found[2] == ["Failed to instantiate model"] * 2 + [True]


CATEGORIES = """
import json
from slave_driver import Slave
slave = Slave(sys.argv[1])
answers = []
for categories in (["logStatusError"], [], ["logStatusError", "50 %s of %n"]):
    try:
        slave.fmu.setDebugLogging(True, categories)
        answers.append(0)
    except Exception as error:
        answers.append(error.status)
print(json.dumps([answers, slave.said, len(slave.start().run(0, 1))]))
"""


def test_a_native_fmu_knows_its_log_categories(native: Native, alone: Alone):
    """Others are refused without harm; pythonfmu's library takes any."""
    ((answers, said, _),) = answered(alone(CATEGORIES, native("bushing")))
    assert answers == [0, 0, ERROR]
    assert said == "50 %%s of %%n is not a log category of this FMU"  # the logger takes a format
