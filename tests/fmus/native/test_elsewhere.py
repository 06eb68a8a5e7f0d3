"""Native FMUs in hosts that know nothing: a program in C without environment, threads, many lives."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest
from places import SUPPORT

Alone = Callable[..., subprocess.CompletedProcess[str]]
Native = Callable[[str], Path]
STEPS, STEP = 150, 2e-5  # s
READ = ("journal.fx", "journal.fy", "journal.mz", "contact.force", "contact.peak_force")
LIFE = "renew start step 0 1e-5 "


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A host in C, compiled."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("there is no C compiler (cc, gcc)")
    path = tmp_path_factory.mktemp("host") / "host"
    subprocess.run([compiler, "-o", path, SUPPORT / "host.c", "-ldl"], check=True)
    return path


def hosted(host: Path, folder: Path, commands: str) -> subprocess.CompletedProcess[str]:
    """Let the host do `commands` to the FMU in `folder`, with an environment that is empty."""
    guid = fromstring((folder / "modelDescription.xml").read_bytes()).attrib["guid"]
    library = next((folder / "binaries" / "linux64").glob("*.so"))
    return subprocess.run(
        [host, library, guid, "file:///nowhere"],
        input=commands, env={}, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip


def references(folder: Path) -> dict[str, str]:
    """Value references by name."""
    xml = fromstring((folder / "modelDescription.xml").read_bytes())
    return {v.attrib["name"]: v.attrib["valueReference"] for v in xml.iter("ScalarVariable")}


def drop(k: int) -> dict[str, float]:
    """Motion of a journal at macro step k: it falls, drifts, touches, and is taken back."""
    phase = math.pi * k / STEPS
    return {
        "journal.x": 0.02 * k * STEP,
        "journal.vx": 0.02,
        "journal.y": -0.32e-3 * math.sin(phase),
        "journal.vy": -0.32e-3 * math.pi / (STEPS * STEP) * math.cos(phase),
        "journal.omega": 900.0,
    }


DROPPED = """
import json
from slave_driver import Slave
rows = json.loads(sys.argv[2])
slave = Slave(sys.argv[1]).start()
for k, row in enumerate(rows):
    slave.set(row)
    slave.fmu.doStep(k * float(sys.argv[3]), float(sys.argv[3]))
    print(*(float(v).hex() for v in slave.get(json.loads(sys.argv[4])).values()))
slave.free()
"""


def test_a_host_in_c_without_an_environment_gets_the_numbers_of_the_fmu_in_python(
    host: Path, native: Native, unpacked: Mapping[str, Path], alone: Alone
):
    known = references(native("bushing"))
    lines = ["start"]
    for k in range(STEPS):
        lines += [f"set {known[name]} {value.hex()}" for name, value in drop(k).items()]
        lines += [f"step {(k * STEP).hex()} {STEP.hex()}", *(f"get {known[name]}" for name in READ)]
    done = hosted(host, native("bushing"), "\n".join(lines))
    assert (done.returncode, done.stderr) == (0, "")
    found = [float.fromhex(text) for text in done.stdout.split()]
    rows = json.dumps([drop(k) for k in range(STEPS)])
    in_python = alone(DROPPED, unpacked["bushing"], rows, STEP, json.dumps(READ))
    assert in_python.returncode == 0, in_python.stderr
    assert found == [float.fromhex(text) for text in in_python.stdout.split()]
    assert max(found[READ.index("contact.force") :: len(READ)]) > 10.0


def test_a_refusal_reaches_the_log_of_a_host_in_c(host: Path, native: Native):
    done = hosted(host, native("housing"), "start step 0 -1")
    assert done.returncode == 3
    assert done.stderr == "hosted: status 3: cannot step from t = 0 s by -1 s; the last step ended at 0 s\n"


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


def test_numbers_of_modes_that_a_rotor_does_not_hold_are_refused_by_name(native: Native, alone: Alone):
    done = alone(HELD, native("rotor_I"))
    assert done.returncode == 0, done.stderr
    five, ten, seven, beyond = json.loads(done.stdout)
    assert five == ten == [False, ""]
    assert seven[0]
    assert "modes = 7, residual = 1; it was built for modes = 2, 5, 10" in seven[1]
    assert beyond[0]
    assert "modes = 999 must be from 2 (rigid)" in beyond[1]
