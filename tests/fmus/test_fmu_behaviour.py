"""What the FMUs do in a host that knows nothing of the project, and what they refuse.

Everything runs in processes of their own where the project cannot be imported, so that a crash or an
abort at the end shows as exit status. What needs no process to itself is asked in slave_questions.py.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from fmpy import extract
from places import COMMAND, ROOT
from slave_answers import judge

from touchdown.fmus.recipes import fmu_names

pytestmark = pytest.mark.slow

Alone = Callable[..., subprocess.CompletedProcess[str]]
Answers = Callable[[str], dict[str, Any]]

NAMES = [name for name in fmu_names() if name != "rotor_II"]  # the code of rotor_I on other data
every_fmu = pytest.mark.parametrize("fmu", NAMES)


def answer(done: subprocess.CompletedProcess[str], warned: bool = False) -> Any:
    """What a script printed last, as JSON; it must have ended well, and silently unless `warned`."""
    assert done.returncode == 0, f"exit status {done.returncode}\n{done.stdout}\n{done.stderr}"
    assert warned or done.stderr == ""
    return json.loads(done.stdout.splitlines()[-1])


def beside_each_other(
    request: pytest.FixtureRequest, fixture: str, run: Callable[[str], subprocess.CompletedProcess[str]]
) -> Callable[[str], subprocess.CompletedProcess[str]]:
    """run(fmu) for every FMU that a chosen test asks `fixture` about, two processes at a time."""
    asking = (item for item in request.session.items if fixture in getattr(item, "fixturenames", ()))
    chosen = {item.callspec.params.get("fmu") for item in asking if hasattr(item, "callspec")}  # type: ignore[attr-defined]
    pool = ThreadPoolExecutor(2)
    started = {fmu: pool.submit(run, fmu) for fmu in NAMES if fmu in chosen}
    return lambda fmu: started[fmu].result() if fmu in started else run(fmu)


@pytest.fixture(scope="module")
def answers(request: pytest.FixtureRequest, alone: Alone, unpacked: Mapping[str, Path]) -> Answers:
    """Answers of an FMU to all questions, asked once; absurd values may make numpy warn."""

    @cache
    def asked(fmu: str) -> subprocess.CompletedProcess[str]:
        other = next(name for name in fmu_names() if name != fmu)
        script = "from slave_questions import ask; ask(*sys.argv[1:])"
        return alone(script, unpacked[fmu], unpacked[other])

    found = beside_each_other(request, "answers", asked)
    return lambda fmu: answer(found(fmu), warned=True)


@pytest.fixture(scope="module")
def left_alone(request: pytest.FixtureRequest, alone: Alone, unpacked: Mapping[str, Path]) -> Answers:
    """What an FMU says of itself where the project cannot be imported."""
    found = beside_each_other(request, "left_alone", lambda fmu: alone(ALONE, unpacked[fmu]))
    return lambda fmu: answer(found(fmu))


# -- standing alone ----------------------------------------------------------------------------------

ALONE = """
import json
from slave_driver import TOUCHING, Slave
before = importable()
slave = Slave(sys.argv[1]).start(TOUCHING)
slave.run(0, 10)
found = slave.outputs()
slave.free()
print(json.dumps({"importable": before + importable(), "loaded": loaded_from_project(), "outputs": found}))
"""


@every_fmu
def test_runs_without_the_project(fmu: str, left_alone: Answers):
    found = left_alone(fmu)
    assert found["importable"] == []
    assert found["loaded"] == []
    assert found["outputs"]
    assert [name for name, value in found["outputs"].items() if not math.isfinite(value)] == []


def test_runs_on_a_host_that_never_saw_it(alone: Alone, unpacked: Mapping[str, Path], tmp_path: Path):
    """Nothing compiled, nothing unpacked before; and the same results."""
    fresh = answer(alone(ALONE, unpacked["housing"], TOUCHDOWN_CACHE=str(tmp_path / "cache")))
    assert fresh["outputs"] == answer(alone(ALONE, unpacked["housing"]))["outputs"]
    assert (tmp_path / "cache").is_dir()


def test_runs_where_nothing_can_be_cached(alone: Alone, unpacked: Mapping[str, Path], tmp_path: Path):
    """In a temporary cache, which one line says."""
    (tmp_path / "file").write_text("no folder")
    done = alone(ALONE, unpacked["housing"], TOUCHDOWN_CACHE=str(tmp_path / "file" / "cache"))
    found = answer(done, warned=True)
    assert done.stderr.startswith(
        f"touchdown: warning: cannot use the cache {tmp_path / 'file' / 'cache'} "
    )
    assert done.stderr.count("\n") == 1
    assert found["loaded"] == []
    assert found["outputs"] == answer(alone(ALONE, unpacked["housing"]))["outputs"]


# -- wherever it lies, beside whatever else ------------------------------------------------------------

ODD = ("with spaces in it", "日本, Größe, 100% + [x] #1")  # names of folders


@pytest.mark.parametrize("name", ODD)
def test_the_master_loads_it_from(name: str, built: Mapping[str, Path], tmp_path: Path):
    """FMU and cache in such a folder: its resources are named to pythonfmu as it reads them."""
    fmu = shutil.copy(built["housing"], (tmp_path / name).with_suffix(".fmu"))
    done = subprocess.run(
        [*COMMAND, "check", fmu],
        env={**os.environ, "TOUCHDOWN_CACHE": str(tmp_path / name)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "outputs finite" in done.stdout
    assert (tmp_path / name / "unpacked").is_dir()


TOGETHER = """
import json
from slave_driver import Slave
slaves = [Slave(folder, str(i)).start() for i, folder in enumerate(sys.argv[1:])]
for k in range(3):
    for slave in slaves:
        slave.set({"seat.fy": -20.0})
        slave.run(k, 1)
print(json.dumps([slave.get(["seat.y"])["seat.y"] for slave in slaves]))
"""


IN_PROCESS_AND_BUILT = """
from pathlib import Path
from touchdown.fmus.build import build_fmu
from touchdown.fmus.recipes import recipe
from touchdown.modelkit.instance import Instance
instance = Instance(recipe("housing").model)
instance.start(0.0)
instance.step(0.0, 1e-4)
build_fmu(recipe("housing"), Path("."))
"""


def test_two_versions_in_one_process(alone: Alone, tmp_path: Path):
    """The other version's housing sags further. Machine code of both was kept under the installed name."""
    other = tmp_path / "other"
    package = other / "touchdown"  # laid out as a wheel is
    package.mkdir(parents=True)
    shutil.copy(ROOT / "src" / "touchdown" / "__init__.py", package)
    for name in ("modelkit", "rotor", "bearings", "fmus"):
        shutil.copytree(ROOT / name, package / name, ignore=shutil.ignore_patterns("__pycache__"))
    housing = package / "bearings" / "supports" / "housing.py"
    text = housing.read_text(encoding="utf-8")
    changed = text.replace("p.y0 - sag", "p.y0 - 2.0 * sag", 1)
    assert changed != text
    housing.write_text(changed, encoding="utf-8")
    kept = {"TOUCHDOWN_CACHE": str(tmp_path / "cache")}
    for folder, path in ((tmp_path, {}), (other, {"PYTHONPATH": str(other)})):
        script = [sys.executable, "-c", IN_PROCESS_AND_BUILT]
        subprocess.run(script, cwd=folder, env={**os.environ, **kept, **path}, check=True)
    folders = [extract(str(path / "housing.fmu"), str(path / "unpacked")) for path in (tmp_path, other)]
    compiled = set((tmp_path / "cache").rglob("*.nbc"))
    first, second = answer(alone(TOGETHER, *folders, **kept))
    assert answer(alone(TOGETHER, *reversed(folders), **kept)) == [second, first]
    assert set((tmp_path / "cache").rglob("*.nbc")) == compiled
    assert first != second


@every_fmu
def test_it_answers_all_questions_as_it_should(fmu: str, answers: Answers):
    """Instances, reset, saved states, and what is refused: by the call, in the log by name."""
    judge(answers(fmu))


FIVE_HUNDRED = """
import gc, json, threading
from slave_driver import Slave

def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1])

def census():
    gc.collect()
    return {
        "pages": resident(),
        "objects": len(gc.get_objects()),
        "search path": len(sys.path),
        "modules": len(sys.modules),
        "threads": len(os.listdir("/proc/self/task")),
        "files": len(os.listdir("/proc/self/fd")),
    }

import os
found = []
for k in range(550):
    slave = Slave(sys.argv[1]).start()
    slave.run(0, 1)
    slave.free()
    if k in (49, 549):
        found.append(census())
print(json.dumps(found))
"""


@pytest.mark.long
def test_five_hundred_instances_leave_nothing_behind(alone: Alone, unpacked: Mapping[str, Path]):
    """What an instance leaves would slow the next one: memory, objects, search path, threads, files."""
    early, late = answer(alone(FIVE_HUNDRED, unpacked["bushing"]))
    assert late["pages"] <= 1.05 * early["pages"]
    assert late.pop("objects") <= 1.05 * early.pop("objects")
    del early["pages"], late["pages"]
    assert late == early


# -- the end of the process --------------------------------------------------------------------------

LEAVING = """
from slave_driver import TOUCHING, Slave
slaves = [Slave(folder).start(TOUCHING) for folder in sys.argv[1:]]
for slave in slaves:
    slave.run(0, 3)
print(len(slaves))
"""


LEAVINGS = 17  # pythonfmu alone crashed more than half of them
ALL_TOGETHER = 5  # every which of them has all FMUs loaded


def leaving(folders: list[Path], k: int) -> list[Path]:
    """FMUs of the k-th process: all of them, or a pair, each FMU in its turn beside the next one."""
    if k % ALL_TOGETHER == 0:
        return folders
    return [folders[k % len(folders)], folders[(k + 1) % len(folders)]]


@pytest.mark.long
def test_leaving_without_cleaning_up_always_ends_well(alone: Alone, unpacked: Mapping[str, Path]):
    """Processes that step FMUs and leave without freeing them; pythonfmu alone crashes most of them."""
    chosen = [leaving(list(unpacked.values()), k) for k in range(LEAVINGS)]
    assert {folder for few in chosen if len(few) == 2 for folder in few} == set(unpacked.values())
    with ThreadPoolExecutor(2) as pool:
        ended = list(pool.map(lambda folders: alone(LEAVING, *folders), chosen))
    assert [done.stdout.strip() for done in ended] == [str(len(folders)) for folders in chosen]
    assert [done.returncode for done in ended] == [0] * LEAVINGS
