"""What the FMUs do in a host that knows nothing of the project, and what they refuse.

Every script runs in a process of its own, so that a crash or an abort at its end shows as exit status.
"""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from fmus.build import names

Alone = Callable[..., subprocess.CompletedProcess[str]]

every_fmu = pytest.mark.parametrize("fmu", names())

HEAD = """
import json, math, sys
from slave_driver import STEP, TOUCHING, Slave
folder = sys.argv[1]
"""


def answer(done: subprocess.CompletedProcess[str]) -> Any:
    """What a script printed last, as JSON; it must have ended well and said nothing on stderr."""
    assert done.returncode == 0, f"exit status {done.returncode}\n{done.stdout}\n{done.stderr}"
    assert done.stderr == ""
    return json.loads(done.stdout.splitlines()[-1])


# -- standing alone ----------------------------------------------------------------------------------

ALONE = """
slave = Slave(folder).start(TOUCHING)
slave.run(0, 10)
found = slave.outputs()
slave.free()
print(json.dumps({"importable": importable(), "loaded": loaded_from_project(), "outputs": found}))
"""


@every_fmu
def test_runs_without_the_project(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    found = answer(alone(HEAD + ALONE, unpacked[fmu]))
    assert found["importable"] == []
    assert found["loaded"] == []
    assert found["outputs"]
    assert [name for name, value in found["outputs"].items() if not math.isfinite(value)] == []


def test_runs_on_a_host_that_never_saw_it(alone: Alone, unpacked: Mapping[str, Path], tmp_path: Path):
    """Nothing compiled, nothing unpacked before; and the same results."""
    fresh = answer(alone(HEAD + ALONE, unpacked["housing"], TOUCHDOWN_CACHE=str(tmp_path / "cache")))
    assert fresh["outputs"] == answer(alone(HEAD + ALONE, unpacked["housing"]))["outputs"]
    assert (tmp_path / "cache").is_dir()


def test_runs_where_nothing_can_be_cached(alone: Alone, unpacked: Mapping[str, Path], tmp_path: Path):
    (tmp_path / "file").write_text("no folder")
    found = answer(alone(HEAD + ALONE, unpacked["housing"], TOUCHDOWN_CACHE=str(tmp_path / "file" / "cache")))
    assert found["loaded"] == []
    assert found["outputs"] == answer(alone(HEAD + ALONE, unpacked["housing"]))["outputs"]


SIMULATED = """
from fmpy import simulate_fmu
found = simulate_fmu(sys.argv[1], stop_time=1e-3, step_size=2e-5, output_interval=2e-5)
finite = all(math.isfinite(value) for row in found.tolist() for value in row)
print(json.dumps({"end": float(found["time"][-1]), "finite": finite, "columns": len(found.dtype.names)}))
"""


@every_fmu
def test_fmpy_simulates_it(fmu: str, alone: Alone, built: Mapping[str, Path]):
    found = answer(alone("import json, math, sys" + SIMULATED, built[fmu]))
    assert found["end"] == pytest.approx(1e-3)
    assert found["finite"]
    assert found["columns"] > 5


# -- instances ---------------------------------------------------------------------------------------

TWO = """
first, second = {**TOUCHING}, {**TOUCHING, "journal.y": -0.315e-3, "seat.fy": -20.0, "A.fy": 20.0}
second |= {"contact.stiffness": 1e9, "stiffness": 3e5, "mass": 3.0}
def one_by_one():
    found = []
    for name, values in (("a", first), ("b", second)):
        slave = Slave(folder, name).start(values)
        found.append(slave.run(0, 12))
        slave.free()
    return found
def side_by_side():
    slaves = [Slave(folder, "a").start(first), Slave(folder, "b").start(second)]
    found = [[], []]
    for k in range(12):
        for slave, rows in zip(slaves, found):
            rows += slave.run(k, 1)
    for slave in slaves:
        slave.free()
    return found
apart, together = one_by_one(), side_by_side()
print(json.dumps({"same": apart == together, "differ": apart[0] != apart[1]}))
"""


@every_fmu
def test_two_instances_do_not_disturb_each_other(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    assert answer(alone(HEAD + TWO, unpacked[fmu])) == {"same": True, "differ": True}


CYCLES = """
found = set()
for _ in range(50):
    slave = Slave(folder).start(TOUCHING)
    found.add(json.dumps(slave.run(0, 1)))
    slave.free()
print(len(found))
"""


@every_fmu
def test_fifty_instances_one_after_the_other(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    assert answer(alone(HEAD + CYCLES, unpacked[fmu])) == 1


RESET = """
slave = Slave(folder).start(TOUCHING)
first = slave.run(0, 5)
slave.fmu.reset()
again = slave.start(TOUCHING).run(0, 5)
slave.free()
print(json.dumps(first == again))
"""


@every_fmu
def test_reset_starts_anew(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    assert answer(alone(HEAD + RESET, unpacked[fmu])) is True


# -- state -------------------------------------------------------------------------------------------

REPLAY = """
def moved(slave, k):
    "Drive it: the journal goes on falling, the body is pushed, so that every step differs."
    slave.set({"journal.y": -0.31e-3 - 0.05 * k * STEP, "A.fy": 30.0 + k, "seat.fy": -30.0 - k})
    return slave.run(k, 1)
slave = Slave(folder).start(TOUCHING)
for k in range(4):
    moved(slave, k)
before = slave.outputs()
state = slave.fmu.getFMUstate()
saved = slave.fmu.serializeFMUstate(state)
first = [moved(slave, k) for k in range(4, 10)]
slave.fmu.setFMUstate(state)
restored = slave.outputs()
again = [moved(slave, k) for k in range(4, 10)]
slave.fmu.freeFMUstate(state)
back = slave.fmu.deSerializeFMUstate(saved)
slave.fmu.setFMUstate(back)
from_bytes = [moved(slave, k) for k in range(4, 10)]
slave.fmu.freeFMUstate(back)
slave.free()
other = Slave(folder, "other").start()
there = other.fmu.deSerializeFMUstate(saved)
other.fmu.setFMUstate(there)
elsewhere = [moved(other, k) for k in range(4, 10)]
other.free()
print(json.dumps({
    "force": before.get("contact.force"), "restored": restored == before, "again": again == first,
    "from bytes": from_bytes == first, "elsewhere": elsewhere == first, "moves": first[0] != first[-1],
}))
"""


@every_fmu
def test_restored_state_replays_to_the_last_bit(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    found = answer(alone(HEAD + REPLAY, unpacked[fmu]))
    force = found.pop("force")
    assert force is None or force > 0.0  # a bearing in mid-contact
    assert all(found.values()), found


def test_bearings_replay_in_contact(unpacked: Mapping[str, Path], alone: Alone):
    """The replay above means contact for every touchdown bearing, and there are some."""
    script = HEAD + "slave = Slave(folder)\nbears = slave.bears\nslave.free()\nprint(json.dumps(bears))"
    bearing = [fmu for fmu in names() if answer(alone(script, unpacked[fmu]))]
    assert set(bearing) >= {"bushing", "simplified_caged", "simplified_cageless"}


FOREIGN = """
other = Slave(sys.argv[2], "other").start(TOUCHING)
foreign = other.fmu.serializeFMUstate(other.fmu.getFMUstate())
slave = Slave(folder).start(TOUCHING)
slave.run(0, 2)
good = slave.fmu.getFMUstate()
own = slave.fmu.serializeFMUstate(good)
expected = slave.run(2, 1)
found = []
for wrong in (foreign, own[:-1], own + b"x", b"", b"x" * len(own)):
    slave.fmu.setFMUstate(good)
    slave.messages.clear()
    state = slave.fmu.deSerializeFMUstate(wrong)
    answered = slave.refuses(slave.fmu.setFMUstate, state)
    found.append([answered or slave.refuses(slave.fmu.doStep, 2 * STEP, STEP), slave.said])
slave.fmu.setFMUstate(good)
revived = slave.run(2, 1) == expected
slave.free()
other.free()
print(json.dumps({"found": found, "revived": revived}))
"""


@every_fmu
def test_a_foreign_state_is_refused(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    other = next(name for name in names() if name != fmu)
    found = answer(alone(HEAD + FOREIGN, unpacked[fmu], unpacked[other]))
    assert len(found["found"]) == 5
    for refused, said in found["found"]:
        assert refused
        assert "not one of this FMU" in said
    assert found["revived"]


# -- what is refused ---------------------------------------------------------------------------------

NOT_FINITE = """
probe = Slave(folder)
inputs = probe.named("input")
probe.free()
found = []
for name in inputs:
    for value in (math.nan, math.inf, -math.inf):
        slave = Slave(folder).start(TOUCHING)
        slave.run(0, 1)
        slave.set({name: value})
        refused = slave.refuses(slave.fmu.doStep, STEP, STEP)
        if not refused or f"input {name} is {value}" not in slave.said:
            found.append([name, str(value), slave.said])
        slave.free()
print(json.dumps({"tried": len(inputs), "wrong": found}))
"""


@every_fmu
def test_an_input_that_is_not_finite_fails_the_step(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    found = answer(alone(HEAD + NOT_FINITE, unpacked[fmu]))
    assert found["tried"] >= 4
    assert found["wrong"] == []


STAYS_FAILED = """
slave = Slave(folder).start(TOUCHING)
name = slave.named("input")[0]
slave.set({name: math.nan})
first = slave.refuses(slave.fmu.doStep, 0.0, STEP)
slave.set({name: 0.0})
second = slave.refuses(slave.fmu.doStep, 0.0, STEP)
slave.free()
print(json.dumps([first, second, slave.messages[-1]]))
"""


@every_fmu
def test_a_failed_instance_stays_failed(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    first, second, said = answer(alone(HEAD + STAYS_FAILED, unpacked[fmu]))
    assert first
    assert second
    assert "stopped before" in said


ABSURD = """
probe = Slave(folder)
inputs = probe.named("input")
probe.free()
found = []
for name in inputs:
    for value in (1e30, -1e30):
        slave = Slave(folder).start(TOUCHING)
        slave.set({name: value})
        if not slave.refuses(slave.fmu.doStep, 0.0, STEP):
            wrong = [n for n, v in slave.outputs().items() if not math.isfinite(v)]
            if wrong:
                found.append([name, value, wrong])
        slave.free()
print(json.dumps(found))
"""


@every_fmu
def test_a_step_that_is_ok_gives_finite_outputs(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    """Finite inputs beyond all sense may be refused, but never answered by NaN and OK."""
    assert answer(alone(HEAD + ABSURD, unpacked[fmu])) == []


BOUNDS = """
probe = Slave(folder)
bad = []
for name in probe.named("parameter"):
    variable = probe.variables[name]
    whole = variable.type == "Integer"
    if variable.min is not None:
        bad.append([name, int(variable.min) - 1 if whole else min(-1.0, float(variable.min) - 1.0)])
    if variable.max is not None:
        bad.append([name, int(variable.max) + 1 if whole else float(variable.max) + 1.0])
    if not whole:
        bad += [[name, math.nan], [name, math.inf]]
probe.free()
wrong = []
for name, value in bad:
    slave = Slave(folder)
    slave.set({name: value})
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    refused = slave.refuses(slave.fmu.exitInitializationMode)
    if not refused or f"{name} = " not in slave.said:
        wrong.append([name, str(value), slave.said])
    slave.free()
good = Slave(folder).start(TOUCHING)
good.run(0, 1)
good.free()
print(json.dumps({"tried": [name for name, _ in bad], "wrong": wrong}))
"""


@every_fmu
def test_a_parameter_out_of_bounds_fails_initialisation(
    fmu: str, alone: Alone, unpacked: Mapping[str, Path]
):
    """And leaves the process fit to run another instance."""
    found = answer(alone(HEAD + BOUNDS, unpacked[fmu]))
    assert found["tried"]
    assert found["wrong"] == []


@pytest.mark.parametrize(
    ("fmu", "name"),
    [
        ("bushing", "clearance"),
        ("simplified_caged", "clearance"),
        ("simplified_cageless", "clearance"),
        ("simplified_caged", "ring.mass"),
        ("housing", "mass"),
        ("rigid_rotor", "mass"),
    ],
)
def test_clearance_and_mass_have_bounds(fmu: str, name: str, alone: Alone, unpacked: Mapping[str, Path]):
    """The parameters that the test above must not miss."""
    assert answer(alone(HEAD + BOUNDS, unpacked[fmu]))["tried"].count(name) >= 3


LEFT_FAILED = """
slave = Slave(folder)
name = next(n for n in slave.named("parameter") if slave.variables[n].min is not None)
slave.set({name: -1})
slave.fmu.setupExperiment(startTime=0.0)
slave.fmu.enterInitializationMode()
print(json.dumps([slave.refuses(slave.fmu.exitInitializationMode), name in slave.said]), flush=True)
"""


@every_fmu
def test_a_process_with_a_failed_instance_ends_well(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    assert answer(alone(HEAD + LEFT_FAILED, unpacked[fmu])) == [True, True]


BAD_STEPS = """
found = []
for step in (0.0, -1e-5, math.nan, math.inf):
    slave = Slave(folder).start(TOUCHING)
    slave.run(0, 1)
    found.append([slave.refuses(slave.fmu.doStep, STEP, step), slave.said])
    slave.free()
slave = Slave(folder).start()
found.append([slave.refuses(slave.fmu.doStep, math.nan, STEP), slave.said])
slave.free()
print(json.dumps(found))
"""


@every_fmu
def test_a_step_that_is_no_step_is_refused(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    found = answer(alone(HEAD + BAD_STEPS, unpacked[fmu]))
    assert len(found) == 5
    for refused, said in found:
        assert refused
        assert "cannot step" in said


TOO_EARLY = """
slave = Slave(folder)
slave.fmu.setupExperiment(startTime=0.0)
slave.fmu.enterInitializationMode()
refused = slave.refuses(slave.fmu.doStep, 0.0, STEP)
slave.free()
print(json.dumps([refused, slave.said]))
"""


@every_fmu
def test_a_step_before_initialisation_is_refused(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    refused, said = answer(alone(HEAD + TOO_EARLY, unpacked[fmu]))
    assert refused
    assert "initialisation" in said


LATE = """
probe = Slave(folder)
names = probe.named("parameter", "output", "local", "calculatedParameter")
probe.free()
wrong = []
for name in names:
    slave = Slave(folder).start(TOUCHING)
    slave.run(0, 1)
    before = slave.get([name])
    answered = slave.refuses(slave.set, {name: 1})
    kept = slave.get([name]) == before
    refused = answered or slave.refuses(slave.fmu.doStep, STEP, STEP)
    if not (refused and kept and name in slave.said):
        wrong.append([name, refused, kept, slave.said])
    slave.free()
print(json.dumps({"tried": len(names), "wrong": wrong}))
"""


@every_fmu
def test_after_initialisation_only_inputs_can_be_set(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    """The value stays, the log names the variable, and the instance does not go on."""
    found = answer(alone(HEAD + LATE, unpacked[fmu]))
    assert found["tried"] > 5
    assert found["wrong"] == []


REFERENCES = """
probe = Slave(folder)
known = {v.valueReference for v in probe.variables.values()}
unknown = [r for r in (*range(max(known) + 3), 10**6, 2**31 - 1, 2**32 - 1) if r not in known]
probe.free()
wrong = []
for reference in unknown:
    for doing in ("getReal", "getInteger", "setReal", "setInteger"):
        slave = Slave(folder).start(TOUCHING)
        arguments = ([reference],) if doing.startswith("get") else ([reference], [1])
        refused = slave.refuses(getattr(slave.fmu, doing), *arguments)
        refused = refused or slave.refuses(slave.fmu.doStep, 0.0, STEP)
        if not refused or str(reference) not in slave.said:
            wrong.append([doing, reference, refused, slave.said.partition(chr(10))[0]])
        slave.free()
print(json.dumps({"tried": len(unknown), "wrong": wrong}))
"""


@every_fmu
def test_an_unknown_value_reference_is_refused(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    found = answer(alone(HEAD + REFERENCES, unpacked[fmu]))
    assert found["tried"] >= 3
    assert found["wrong"] == []


MIXED = """
probe = Slave(folder)
names = [n for n in probe.named("parameter", "input", "output") if probe.variables[n].type in ("Real", "Integer")]
probe.free()
wrong = []
for name in names:
    slave = Slave(folder)
    variable = slave.variables[name]
    other = "Integer" if variable.type == "Real" else "Real"
    read = slave.refuses(getattr(slave.fmu, f"get{other}"), [variable.valueReference])
    if variable.causality != "output":
        before = slave.get([name])
        slave.refuses(getattr(slave.fmu, f"set{other}"), [variable.valueReference], [2])
        if slave.get([name]) != before:
            wrong.append([name, f"set{other}"])
    if not read and not slave.said:
        wrong.append([name, f"get{other}"])
    slave.free()
print(json.dumps(wrong))
"""


@every_fmu
def test_a_variable_is_reached_by_its_own_type_only(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    assert answer(alone(HEAD + MIXED, unpacked[fmu])) == []


# -- the end of the process --------------------------------------------------------------------------

LEAVING = """
from slave_driver import STEP, TOUCHING, Slave
slaves = [Slave(folder).start(TOUCHING) for folder in sys.argv[1:]]
for slave in slaves:
    slave.run(0, 3)
print(len(slaves))
"""


def exits(alone: Alone, folders: list[Path], count: int) -> list[int]:
    """Exit statuses of `count` processes that load all FMUs, step them and leave without freeing them."""
    with ThreadPoolExecutor(2) as pool:
        ended = list(pool.map(lambda _: alone(LEAVING, *folders), range(count)))
    assert [done.stdout.strip() for done in ended] == [str(len(folders))] * count
    return [done.returncode for done in ended]


def test_leaving_without_cleaning_up_ends_well(alone: Alone, unpacked: Mapping[str, Path]):
    assert exits(alone, list(unpacked.values()), 10) == [0] * 10


@pytest.mark.long
def test_leaving_without_cleaning_up_always_ends_well(alone: Alone, unpacked: Mapping[str, Path]):
    assert exits(alone, list(unpacked.values()), 50) == [0] * 50
