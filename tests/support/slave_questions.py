"""Questions put to one FMU through FMI alone, each answered by plain data.

`python -c "from slave_questions import ask; ask(...)"` answers all of them in one process and prints the
answers as JSON. `slave_answers` judges them; here nothing is asserted.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

from slave_driver import STEP, TOUCHING, Slave

PUSHED = {"journal.y": -0.315e-3, "seat.fy": -20.0, "A.fy": 20.0}
PARAMETERS = {"contact.stiffness": 1e9, "stiffness": 3e5, "mass": 3.0, "gain.proportional": 5e3}
CHANGED = {**TOUCHING, **PUSHED, **PARAMETERS}


def started(folder: str, steps: int = 0) -> Slave:
    """An instance that has taken `steps` macro steps, a bearing with its journal in contact."""
    slave = Slave(folder).start(TOUCHING)
    slave.run(0, steps)
    return slave


def entered(folder: str) -> Slave:
    """An instance that is being initialised."""
    slave = Slave(folder)
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    return slave


def names_of(folder: str, *causalities: str) -> list[str]:
    """Names of the FMU's variables of these causalities."""
    slave = Slave(folder)
    found = slave.named(*causalities)
    slave.free()
    return found


def steps_on(slave: Slave, k: int = 0) -> bool:
    """Whether the instance takes macro step number `k`."""
    return not slave.refuses(slave.fmu.doStep, k * STEP, STEP)


# -- instances ---------------------------------------------------------------------------------------


def one_by_one(folder: str) -> list[list[dict[str, str]]]:
    """Two runs with different parameters and inputs, the second after the first."""
    found = []
    for values in (TOUCHING, CHANGED):
        slave = Slave(folder).start(values)
        found.append(slave.run(0, 12))
        slave.free()
    return found


def side_by_side(folder: str) -> list[list[dict[str, str]]]:
    """The same two runs, stepped in turns."""
    slaves = [Slave(folder, "a").start(TOUCHING), Slave(folder, "b").start(CHANGED)]
    found: list[list[dict[str, str]]] = [[], []]
    for k in range(12):
        for slave, rows in zip(slaves, found, strict=True):
            rows += slave.run(k, 1)
    for slave in slaves:
        slave.free()
    return found


def two_instances(folder: str, _: str) -> dict[str, bool]:
    """Whether two instances give what they give alone, and differ."""
    apart, together = one_by_one(folder), side_by_side(folder)
    return {"same": apart == together, "differ": apart[0] != apart[1]}


def fifty_instances(folder: str, _: str) -> int:
    """How many different results fifty instances give, one after the other."""
    found = set()
    for _ in range(50):
        slave = Slave(folder).start(TOUCHING)
        found.add(json.dumps(slave.run(0, 1)))
        slave.free()
    return len(found)


def reset(folder: str, _: str) -> bool:
    """Whether a reset instance runs as a new one does."""
    slave = Slave(folder).start(TOUCHING)
    first = slave.run(0, 5)
    slave.fmu.reset()
    again = slave.start(TOUCHING).run(0, 5)
    slave.free()
    return first == again


# -- state -------------------------------------------------------------------------------------------


def moved(slave: Slave, first: int, count: int) -> list[dict[str, str]]:
    """Macro steps under inputs that change: the journal goes on falling, a body is pushed harder."""
    rows = []
    for k in range(first, first + count):
        slave.set({"journal.y": -0.31e-3 - 0.05 * k * STEP, "A.fy": 30.0 + k, "seat.fy": -30.0 - k})
        rows += slave.run(k, 1)
    return rows


def unlike_defaults(folder: str) -> Slave:
    """An initialised instance with every real parameter a hundredth larger than by default, or smaller."""
    slave = Slave(folder, "unlike")
    parameters = [slave.variables[name] for name in slave.named("parameter")]
    real = {v.name: (float(v.start), float(v.max or "inf")) for v in parameters if v.type == "Real"}
    larger = {name: 1.01 * start for name, (start, _) in real.items()}
    within = {n: value if value <= real[n][1] else 0.99 * real[n][0] for n, value in larger.items()}
    return slave.start(within)


def saved_early(folder: str, _: str) -> bool:
    """Whether a state saved during initialisation brings back the outputs of its own parameters."""
    slave = entered(folder)
    name = next(n for n in slave.named("parameter") if slave.variables[n].type == "Real")
    slave.set({name: 1.01 * float(slave.variables[name].start)})
    state = slave.fmu.getFMUstate()
    before = slave.outputs()
    slave.fmu.setFMUstate(state)
    after = slave.outputs()
    slave.free()
    return after == before


def replay(folder: str, _: str) -> dict[str, Any]:
    """Whether what follows a saved state is repeated to the last bit, here and in other instances."""
    slave, other, unlike = started(folder), Slave(folder, "other").start(), unlike_defaults(folder)
    moved(slave, 0, 4)
    before = slave.outputs()
    state = slave.fmu.getFMUstate()
    saved = slave.fmu.serializeFMUstate(state)
    first = moved(slave, 4, 6)
    slave.fmu.setFMUstate(state)
    found: dict[str, Any] = {"outputs": slave.outputs() == before, "again": moved(slave, 4, 6) == first}
    slave.fmu.freeFMUstate(state)
    places = {"from bytes": slave, "in another instance": other, "where parameters were others": unlike}
    for where, instance in places.items():
        state = instance.fmu.deSerializeFMUstate(saved)
        instance.fmu.setFMUstate(state)
        instance.fmu.freeFMUstate(state)
        found[where] = moved(instance, 4, 6) == first
        instance.free()
    return found | {"moves": first[0] != first[-1], "force": before.get("contact.force")}


def foreign_states(folder: str, other_folder: str) -> dict[str, Any]:
    """Per wrong state whether it is refused and what is said; whether the own state still works."""
    other, slave = started(other_folder), started(folder, 2)
    foreign = other.fmu.serializeFMUstate(other.fmu.getFMUstate())
    good = slave.fmu.getFMUstate()
    own = slave.fmu.serializeFMUstate(good)
    expected = slave.run(2, 1)
    found = []
    for wrong in (foreign, own[:-1], own + b"x", b"", b"x" * len(own)):
        slave.fmu.setFMUstate(good)
        slave.messages.clear()
        refused = slave.refuses(slave.fmu.deSerializeFMUstate, wrong)
        found.append([refused or not steps_on(slave, 2), slave.said])
    slave.fmu.setFMUstate(good)
    revived = slave.run(2, 1) == expected
    slave.free()
    other.free()
    return {"found": found, "revived": revived}


# -- inputs ------------------------------------------------------------------------------------------


def inputs_not_finite(folder: str, _: str) -> dict[str, Any]:
    """Inputs whose NaN or infinity is not refused by name."""
    wrong = []
    inputs = [
        name for name in names_of(folder, "input") if ".mode[" not in name
    ]  # these modes are not there
    for name in inputs:
        for value in (math.nan, math.inf, -math.inf):
            slave = started(folder, 1)
            slave.set({name: value})
            if steps_on(slave, 1) or f"input {name} is {value}" not in slave.said:
                wrong.append([name, str(value), slave.said])
            slave.free()
    return {"tried": len(inputs), "wrong": wrong}


def failure_lasts(folder: str, _: str) -> list[Any]:
    """Whether a failed instance steps after its input was mended, and what it says."""
    slave = Slave(folder).start(TOUCHING)
    name = slave.named("input")[0]
    slave.set({name: math.nan})
    first = steps_on(slave)
    slave.set({name: 0.0})
    second = steps_on(slave)
    slave.free()
    return [first, second, slave.said]


def absurd_inputs(folder: str, _: str) -> list[Any]:
    """Finite inputs beyond all sense that are answered by OK and outputs that are not finite."""
    wrong = []
    for name in names_of(folder, "input"):
        for value in (1e30, -1e30):
            slave = Slave(folder).start(TOUCHING)
            slave.set({name: value})
            if steps_on(slave):
                bad = [n for n, v in slave.outputs().items() if not math.isfinite(v)]
                wrong += [[name, value, bad]] if bad else []
            slave.free()
    return wrong


# -- parameters --------------------------------------------------------------------------------------


def out_of_bounds(slave: Slave) -> list[tuple[str, float]]:
    """Values beyond each bound of each parameter, and NaN and infinity for the real ones."""
    found: list[tuple[str, float]] = []
    for name in slave.named("parameter"):
        variable = slave.variables[name]
        whole = variable.type != "Real"
        if variable.min is not None:
            found.append((name, int(variable.min) - 1 if whole else float(variable.min) - 1.0))
        if variable.max is not None:
            found.append((name, int(variable.max) + 1 if whole else float(variable.max) + 1.0))
        if not whole:
            found += [(name, math.nan), (name, math.inf)]
    return found


def bad_parameters(folder: str, _: str) -> dict[str, Any]:
    """Parameters whose bad value does not fail initialisation by name; then an instance that is good."""
    probe = Slave(folder)
    bad = out_of_bounds(probe)
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
    started(folder, 1).free()
    return {"tried": [name for name, _ in bad], "wrong": wrong}


def set_too_late(folder: str, _: str) -> dict[str, Any]:
    """Variables other than inputs and tunable parameters that can be set after initialisation."""
    names = names_of(folder, "parameter", "output", "local", "calculatedParameter")
    wrong = []
    for name in names:
        slave = started(folder, 1)
        before = slave.get([name])
        variable = slave.variables[name]
        if variable.variability == "tunable":
            continue
        write = slave.fmu.setReal if variable.type == "Real" else slave.fmu.setInteger
        answered = slave.refuses(write, [variable.valueReference], [1])
        kept = slave.get([name]) == before
        refused = answered or not steps_on(slave, 1)
        if not (refused and kept and name in slave.said):
            wrong.append([name, refused, kept, slave.said])
        slave.free()
    return {"tried": len(names), "wrong": wrong}


# -- steps and references ----------------------------------------------------------------------------


def rounded_times(folder: str, _: str) -> bool:
    """Whether steps are taken whose beginnings are off by what hosts round."""
    slave = started(folder, 1)
    taken = [
        not slave.refuses(slave.fmu.doStep, k * STEP + error, STEP) for k, error in ((1, 1e-9), (2, 0.0))
    ]
    slave.free()
    return all(taken)


def begin_anew(folder: str, _: str) -> bool:
    """Whether a start time other than 0 and a step back by the saved state are taken."""
    slave = Slave(folder)
    slave.fmu.setupExperiment(startTime=1.0)
    slave.fmu.enterInitializationMode()
    slave.fmu.exitInitializationMode()
    slave.fmu.doStep(1.0, STEP)
    state = slave.fmu.getFMUstate()
    slave.fmu.doStep(1.0 + STEP, STEP)
    slave.fmu.setFMUstate(state)
    slave.fmu.freeFMUstate(state)
    taken = not slave.refuses(slave.fmu.doStep, 1.0 + STEP, STEP)
    slave.free()
    return taken


def read_after_the_end(folder: str, _: str) -> bool:
    """Whether outputs stay what they were when the instance is terminated."""
    slave = started(folder, 2)
    before = slave.outputs()
    slave.fmu.terminate()
    after = slave.outputs()
    slave.free()
    return before == after


def unknown_references(folder: str, _: str) -> dict[str, Any]:
    """Value references that no variable has and that can be read or set all the same."""
    probe = Slave(folder)
    known = {v.valueReference for v in probe.variables.values()}
    probe.free()
    below = [r for r in range(max(known)) if r not in known]
    unknown = [*below[:10], *below[10 :: 1 + len(below) // 10], max(known) + 1, 10**6, 2**31 - 1, 2**32 - 1]
    wrong = []
    for reference in unknown:
        for doing in ("getReal", "getInteger", "setReal", "setInteger"):
            slave = started(folder)
            values = ([1],) if doing.startswith("set") else ()
            answered = slave.refuses(getattr(slave.fmu, doing), [reference], *values)
            if not (answered or not steps_on(slave)) or "value reference" not in slave.said:
                wrong.append([doing, reference, slave.said])
            slave.free()
    return {"tried": len(unknown), "wrong": wrong}


def mixed_types(folder: str, _: str) -> list[Any]:
    """Variables that can be read or set through the functions of the other type."""
    wrong = []
    for name in names_of(folder, "parameter", "input", "output"):
        slave = entered(folder)
        variable = slave.variables[name]
        other = "Integer" if variable.type == "Real" else "Real"
        read, write = getattr(slave.fmu, f"get{other}"), getattr(slave.fmu, f"set{other}")
        if not slave.refuses(read, [variable.valueReference]) and not slave.said:
            wrong.append([f"get{other}", name])
        before = slave.get([name])
        slave.refuses(write, [variable.valueReference], [2])
        if slave.get([name]) != before:
            wrong.append([f"set{other}", name])
        slave.free()
    return wrong


QUESTIONS: tuple[Callable[[str, str], Any], ...] = (
    two_instances, fifty_instances, reset, replay, saved_early, foreign_states, inputs_not_finite,
    failure_lasts, absurd_inputs, bad_parameters, set_too_late, unknown_references, mixed_types,
    rounded_times, begin_anew, read_after_the_end,
)  # fmt: skip


def ask(folder: str, other_folder: str) -> None:
    """Print the answers to all questions about the FMU in `folder`; the other one is a stranger to it."""
    print(json.dumps({question.__name__: question(folder, other_folder) for question in QUESTIONS}))
