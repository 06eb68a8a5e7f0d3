"""Native FMUs in hosts that know nothing: a program in C without environment, threads, many lives."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path

import hosting
import pytest
from hosting import READ, Alone, drop, dropped_through_fmpy, numbers

Native = Callable[[str], Path]
LIFE = "renew start step 0 1e-5 "


def hosted(host: Path, folder: Path, commands: str) -> subprocess.CompletedProcess[str]:
    """Let the host do `commands` to the FMU in `folder`, with an environment that is empty."""
    return hosting.hosted(host, folder, commands, "file:///nowhere", {})


@pytest.mark.slow
def test_a_host_in_c_without_an_environment_gets_the_numbers_of_the_fmu_in_python(
    host: Path, native: Native, unpacked: Mapping[str, Path], alone: Alone
):
    done = hosted(host, native("bushing"), drop(native("bushing")))
    assert (done.returncode, done.stderr) == (0, "")
    found = numbers(done.stdout)
    assert found == dropped_through_fmpy(alone, unpacked["bushing"])
    assert max(found[READ.index("contact.force") :: len(READ)]) > 10.0


def test_a_refusal_reaches_the_log_of_a_host_in_c(host: Path, native: Native):
    done = hosted(host, native("housing"), "start step 0 -1")
    assert done.returncode == 3
    assert done.stderr == "hosted: status 3: cannot step from t = 0 s by -1 s; the last step ended at 0 s\n"


@pytest.mark.slow
@pytest.mark.parametrize("fmu", ["housing", "bushing", "rotor_I"])
def test_a_thousand_lives_leave_nothing_behind(fmu: str, host: Path, native: Native):
    said = hosted(host, native(fmu), f"{100 * LIFE} memory {100 * LIFE} memory {1000 * LIFE} memory")
    assert said.returncode == 0, said.stderr
    _, before, after = map(float.fromhex, said.stdout.split())  # the host's own room for text comes first
    assert after - before < 16.0  # kB, of all of them


THREADS = """
import json, threading
from slave_driver import TOUCHING, Slave
CHANGED = {**TOUCHING, "journal.y": -0.315e-3, "contact.stiffness": 1e9, "mass": 3.0, "seat.fy": -20.0}
def run(k, found):
    slave = Slave(sys.argv[1], str(k)).start(CHANGED if k % 2 else TOUCHING)
    found[k] = slave.run(0, 150)
    slave.free()
alone, together = {}, {}
for k in range(2):
    run(k, alone)
threads = [threading.Thread(target=run, args=(k, together)) for k in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(json.dumps([[together[k] == alone[k % 2] for k in range(4)], alone[0] != alone[1]]))
"""


def test_instances_on_four_threads_do_not_disturb_each_other(native: Native, alone: Alone):
    done = alone(THREADS, native("bushing"))
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [[True] * 4, True]


HELD = """
import json
from slave_driver import Slave
found = []
for values in ({"modes": 5}, {"modes": 10, "residual": 0}, {"modes": 7}, {"modes": 999}):
    slave = Slave(sys.argv[1])
    slave.set(values)
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    found.append([slave.refuses(slave.fmu.exitInitializationMode), slave.said])
    slave.free()
print(json.dumps(found))
"""


@pytest.mark.native
def test_numbers_of_modes_that_a_rotor_does_not_hold_are_refused_by_name(native: Native, alone: Alone):
    done = alone(HELD, native("rotor_I"))
    assert done.returncode == 0, done.stderr
    five, ten, seven, beyond = json.loads(done.stdout)
    assert five == ten == [False, ""]
    assert seven[0]
    assert "modes = 7, residual = 1; it was built for modes = 2, 5, 10" in seven[1]
    assert beyond[0]
    assert "modes = 999 must be from 2 (rigid)" in beyond[1]
