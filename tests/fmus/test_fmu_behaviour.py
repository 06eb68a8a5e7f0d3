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

from touchdown.fmus.recipes import names

pytestmark = pytest.mark.slow

Alone = Callable[..., subprocess.CompletedProcess[str]]
Answers = Callable[[str], dict[str, Any]]

NAMES = [name for name in names() if name != "rotor_II"]  # the code of rotor_I on other data
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
        other = next(name for name in names() if name != fmu)
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


SIMULATED = """
import json, math
from fmpy import simulate_fmu
found = simulate_fmu(sys.argv[1], stop_time=1e-3, step_size=2e-5, output_interval=2e-5)
finite = all(math.isfinite(value) for row in found.tolist() for value in row)
print(json.dumps({"end": float(found["time"][-1]), "finite": finite, "columns": len(found.dtype.names)}))
"""


@pytest.mark.parametrize("fmu", ["amb", "bushing", "housing", "rigid_rotor"])  # one of each kind
def test_fmpy_simulates_it(fmu: str, alone: Alone, built: Mapping[str, Path]):
    found = answer(alone(SIMULATED, built[fmu]))
    assert found["end"] == pytest.approx(1e-3)
    assert found["finite"]
    assert found["columns"] > 5


# -- wherever it lies, beside whatever else ------------------------------------------------------------

ODD = ("with spaces in it", "Größe und Maß", "日本", "100% + [x] #1")  # names of folders


@pytest.mark.parametrize("name", ODD[:1])
def test_any_host_loads_it_from(name: str, alone: Alone, unpacked: Mapping[str, Path], tmp_path: Path):
    folder = shutil.copytree(unpacked["housing"], tmp_path / name)
    assert answer(alone(ALONE, folder))["outputs"]


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


BESIDE_ANOTHER_VERSION = """
import json
sys.meta_path.pop(0)
sys.path.insert(0, sys.argv[2])
import touchdown
from slave_driver import TOUCHING, Slave
slave = Slave(sys.argv[1]).start(TOUCHING)
slave.run(0, 10)
print(json.dumps({"installed": touchdown.WHAT, "outputs": slave.outputs()}))
"""


def test_another_version_of_the_project_is_installed(
    alone: Alone, unpacked: Mapping[str, Path], tmp_path: Path
):
    """The FMU goes by its own sources, whatever is called as they were."""
    (tmp_path / "touchdown").mkdir()
    (tmp_path / "touchdown" / "__init__.py").write_text("WHAT = 'another'\n")
    found = answer(alone(BESIDE_ANOTHER_VERSION, unpacked["housing"], tmp_path))
    assert found["installed"] == "another"
    assert found["outputs"] == answer(alone(ALONE, unpacked["housing"]))["outputs"]


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
from touchdown.fmus.build import build
from touchdown.fmus.recipes import recipe
from touchdown.modelkit.instance import Instance
instance = Instance(recipe("housing").model)
instance.start(0.0)
instance.step(0.0, 1e-4)
build(recipe("housing"), Path("."))
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


# -- instances ---------------------------------------------------------------------------------------


@every_fmu
def test_two_instances_do_not_disturb_each_other(fmu: str, answers: Answers):
    assert answers(fmu)["two_instances"] == {"same": True, "differ": True}


@every_fmu
def test_fifty_instances_one_after_the_other(fmu: str, answers: Answers):
    assert answers(fmu)["fifty_instances"] == 1


@every_fmu
def test_reset_starts_anew(fmu: str, answers: Answers):
    assert answers(fmu)["reset"] is True


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


# -- state -------------------------------------------------------------------------------------------


@every_fmu
def test_restored_state_replays_to_the_last_bit(fmu: str, answers: Answers):
    found = {key: value for key, value in answers(fmu)["replay"].items() if key != "force"}
    places = ("again", "from bytes", "in another instance", "where parameters were others")
    assert found == dict.fromkeys(("outputs", *places, "moves"), True)


@every_fmu
def test_a_state_saved_before_initialisation_is_that_of_its_parameters(fmu: str, answers: Answers):
    assert answers(fmu)["saved_early"]


def test_bearings_replay_in_contact(answers: Answers):
    """Where the replay above begins, every touchdown bearing bears."""
    forces = {fmu: answers(fmu)["replay"]["force"] for fmu in NAMES}
    bearing = {fmu: force for fmu, force in forces.items() if force is not None}
    assert set(bearing) >= {"bushing", "simplified_caged", "simplified_cageless"}
    assert [fmu for fmu, force in bearing.items() if not force > 0.0] == []


@every_fmu
def test_a_foreign_state_is_refused(fmu: str, answers: Answers):
    """By the call or by the step after it; the instance can still go back to a state of its own."""
    found = answers(fmu)["foreign_states"]
    assert [refused for refused, _ in found["found"]] == [True] * 5
    assert [said for _, said in found["found"] if "not one of this FMU" not in said] == []
    assert found["revived"]


# -- what is refused ---------------------------------------------------------------------------------


@every_fmu
def test_an_input_that_is_not_finite_fails_the_step(fmu: str, answers: Answers):
    found = answers(fmu)["inputs_not_finite"]
    assert found["tried"] >= 4
    assert found["wrong"] == []


@every_fmu
def test_a_failed_instance_stays_failed(fmu: str, answers: Answers):
    first, second, said = answers(fmu)["failure_lasts"]
    assert (first, second) == (False, False)
    assert "stopped before" in said


@every_fmu
def test_a_step_that_is_ok_gives_finite_outputs(fmu: str, answers: Answers):
    """Finite inputs beyond all sense may be refused, but never answered by NaN and OK."""
    assert answers(fmu)["absurd_inputs"] == []


@every_fmu
def test_a_parameter_out_of_bounds_fails_initialisation(fmu: str, answers: Answers):
    """By its name; and the process is fit to run another instance."""
    found = answers(fmu)["bad_parameters"]
    assert found["tried"]
    assert found["wrong"] == []


@pytest.mark.parametrize(
    ("fmu", "name"),
    [
        ("bushing", "clearance"),
        ("simplified_caged", "clearance"),
        ("simplified_cageless", "clearance"),
        ("simplified_caged", "ring.mass"),
        ("simplified_cageless", "ring.mass"),
        ("housing", "mass"),
        ("rigid_rotor", "mass"),
    ],
)
def test_clearance_and_mass_have_bounds(fmu: str, name: str, answers: Answers):
    """A negative one is among those that were tried above."""
    assert answers(fmu)["bad_parameters"]["tried"].count(name) >= 3


LEFT_FAILED = """
import json
from slave_driver import Slave
slave = Slave(sys.argv[1])
name = next(n for n in slave.named("parameter") if slave.variables[n].min is not None)
slave.set({name: -1})
slave.fmu.setupExperiment(startTime=0.0)
slave.fmu.enterInitializationMode()
print(json.dumps([slave.refuses(slave.fmu.exitInitializationMode), name in slave.said]), flush=True)
"""


@every_fmu
def test_a_process_with_a_failed_instance_ends_well(fmu: str, alone: Alone, unpacked: Mapping[str, Path]):
    assert answer(alone(LEFT_FAILED, unpacked[fmu])) == [True, True]


@every_fmu
def test_a_step_that_is_no_step_is_refused(fmu: str, answers: Answers):
    found = answers(fmu)["bad_steps"]
    assert [taken for taken, _ in found] == [False] * 5
    assert [said for _, said in found if "cannot step" not in said] == []


@every_fmu
def test_a_step_before_initialisation_is_refused(fmu: str, answers: Answers):
    taken, said = answers(fmu)["too_early"]
    assert not taken
    assert "initialisation" in said


@every_fmu
def test_steps_follow_each_other(fmu: str, answers: Answers):
    """Back in time, or leaving a gap: refused. Off by what hosts round: taken."""
    found = answers(fmu)["steps_apart"]
    assert [taken for taken, _ in found] == [False] * 4
    assert [said for _, said in found if "the last step ended at 4e-05 s" not in said] == []
    assert answers(fmu)["rounded_times"]
    assert answers(fmu)["begin_anew"]


@every_fmu
def test_calls_out_of_order_are_refused(fmu: str, answers: Answers):
    """By one clear line, and the process runs on."""
    found = answers(fmu)["out_of_order"]
    assert len(found) == 9
    assert {name: said for name, (refused, said) in found.items() if not refused} == {}
    assert {name for name, (_, said) in found.items() if len(said.splitlines()) != 1} == set()
    for name, said in (
        ("setup when running", "before initialisation only"),
        ("setup at no time", "start time is nan s"),
        ("enter twice", "reset the FMU"),
        ("exit without entering", "must be entered"),
        ("step when new", "before initialisation is complete"),
        ("step after the end", "after the end"),
    ):
        assert said in found[name][1]
    assert answers(fmu)["read_after_the_end"]


@every_fmu
def test_after_initialisation_only_inputs_and_what_is_tunable_can_be_set(fmu: str, answers: Answers):
    """The value stays, the log names the variable, and the instance does not go on."""
    found = answers(fmu)["set_too_late"]
    assert found["tried"] > 5
    assert found["wrong"] == []


@every_fmu
def test_an_unknown_value_reference_is_refused(fmu: str, answers: Answers):
    found = answers(fmu)["unknown_references"]
    assert found["tried"] >= 3
    assert found["wrong"] == []


@every_fmu
def test_a_variable_is_reached_by_its_own_type_only(fmu: str, answers: Answers):
    assert answers(fmu)["mixed_types"] == []


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
