"""Code of others that ends, breaks or hangs its process: one line, a status, and what was recorded."""

from __future__ import annotations

import ctypes
import json
import time
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np
import pytest
from commands import Command
from misbehaving import CHECKED, COMPILER, DEEDS, FMI, misbehaving, patience, scene_with
from misbehaving import compiled as compiled_library

from touchdown.command.cli import main
from touchdown.fmus import build
from touchdown.master.common.errors import FAILED, STOPPED, TouchdownError
from touchdown.master.components.fmu import FmuComponent
from touchdown.master.components.isolation.isolated import IsolatedFmu
from touchdown.master.components.log import KEPT, FmuLog, compiled
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.modelkit.kernel.cache_folder import user_cache

pytestmark = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler (cc, gcc)")

Make = Callable[[str, str], Path]
HOW = {
    "exit": "ended its process with status 0",
    "_exit": "ended its process with status 0",
    "abort": "crashed with SIGABRT",
    "segv": "crashed with SIGSEGV",
    "hang": "did not answer within 1 s",
    "error": "it answered 'error'",
    "fatal": "fatal",
    "nan": "fy",  # and what it is not
}
QUIET = ("--in-process", "--no-pictures", "--quiet")


@pytest.fixture(scope="module")
def make(tmp_path_factory: pytest.TempPathFactory) -> Make:
    """FMUs by what they do, and in which call."""
    library = compiled_library(tmp_path_factory.mktemp("misbehaving"))
    return lambda call, deed: misbehaving(library, call, deed)


# -- in a process of its own -------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(("call", "deed"), DEEDS)
def test_a_run_says_what_an_fmu_did(call: str, deed: str, make: Make, command: Command, tmp_path: Path):
    """By component, call and time; and what was recorded before is there."""
    out = tmp_path / "out"
    ended = command("run", scene_with(make(call, deed)), *QUIET, "-o", out)
    assert HOW[deed] in ended.line
    assert "bearing" in ended.line
    if call in ("step", "terminate", "free"):
        assert ended.status == STOPPED
        summary = json.loads((out / "summary.json").read_text())
        assert not summary["completed"]
        assert summary["stopped_because"] in ended.line
        with h5py.File(out / "result.h5") as file:
            rows = len(file["time"])
            assert rows == len(file["bearing/journal.fy"]) == (3 if call == "step" else 101)
    else:
        assert ended.status == FAILED
    if deed not in ("error", "fatal", "nan"):
        time = {"step": 4e-5, "terminate": 1.98e-3, "free": 1.98e-3}.get(call, 0.0)
        assert f" in {FMI[call]} at t = {time:g} s" in ended.line


@pytest.mark.parametrize(("call", "deed"), CHECKED)
def test_a_check_says_what_an_fmu_did(call: str, deed: str, make: Make, capfd: pytest.CaptureFixture[str]):
    fmu = make(call, deed)
    assert main(["check", str(fmu), "--call-timeout", patience(fmu)]) == FAILED
    said = capfd.readouterr()
    lines = [*said.err.splitlines(), *(line for line in said.out.splitlines() if "problem: " in line)]
    assert len(lines) == 1, lines
    assert HOW[deed] in lines[0]
    if deed not in ("error", "fatal", "nan"):
        assert FMI[call] in lines[0]


@pytest.mark.parametrize(
    ("isolate", "call", "deed"),
    [*((False, "step", "null"), (True, "enter", "null"), (True, "step", "noise"))],
)
def test_what_does_no_harm(isolate: bool, call: str, deed: str, make: Make):
    scene = load_scene(str(scene_with(make(call, deed)))).set({"bearing.isolate": isolate})
    with opened(scene, in_process=True) as system:
        simulate(scene, system).raise_if_stopped()


@pytest.mark.parametrize("call", ["instantiate", "step"])
def test_a_changed_directory_does_no_harm(call: str, make: Make, command: Command):
    scene = scene_with(make(call, "chdir"))
    here = Path.cwd()
    assert command("run", scene, *QUIET, "-o", "out").status == 0
    assert Path.cwd() == here
    assert json.loads((here / "out/summary.json").read_text())["completed"]


def test_it_steps_to_the_last_bit_as_here(make: Make):
    """Values, and all that a component is asked for."""
    path, names = make("never", "mind"), ("journal.x", "journal.fy", "journal.fx", "journal.fy")
    found = []
    for kind in (FmuComponent, IsolatedFmu):
        component = kind("bearing", path, user_cache())
        component.rename({"journal.up": "journal.fy"})
        outputs = np.zeros(2)
        component.set({"journal.x": 0.25})
        component.bind(["journal.y"], outputs, ["journal.fx", "journal.up"])
        component.enter(0.0)
        component.exit()
        fetch = component.reader([name.replace("fy", "up") for name in names])
        seen = []
        for k in range(5):
            component.inputs[:] = 1e-3 * np.sqrt(k)
            component.push()
            seen += [*outputs, *fetch()]  # before the step, and what was pushed
            component.step(k * 0.1, 0.1)
            component.pull()
            seen += [*outputs, *fetch(), *component.read(["journal.up"])]
        assert component.close() == ""
        assert component.close() == ""
        found.append(seen)
    assert found[0] == found[1]
    assert len({abs(value) for value in found[0]}) > 5


def test_states_are_saved_and_restored_there(built: dict[str, Path], tmp_path: Path):
    """A project's own, changed: the scheme takes components back in time."""
    changed = tmp_path / "changed.fmu"
    changed.write_bytes(built["simplified_caged"].read_bytes())
    with zipfile.ZipFile(changed, "a") as archive:
        archive.writestr("resources/more.txt", "")
    scene = load_scene("disk-caged-simplified").set(
        {"run.duration": 1e-4, "amb.shutdown_time": 0.0, "run.scheme": "iterated"}
    )
    ends = []
    for fmu, kind in ((changed, IsolatedFmu), (built["simplified_caged"], FmuComponent)):
        with opened(scene.swap(bearing=fmu)) as system:
            assert isinstance(system.components["bearing"], kind)
            simulate(scene, system).raise_if_stopped()
            ends.append([system.value(name) for name in ("rotor.A.y", "rotor.A.vy")])
    assert ends[0] == ends[1]


@pytest.mark.parametrize(
    ("deed", "said"), [("close", "closed files that it did not open"), ("kill", "was ended by SIGKILL")]
)
def test_what_else_an_fmu_may_do(deed: str, said: str, make: Make):
    component = IsolatedFmu("bearing", make("enter", deed), user_cache())

    def initialise() -> None:
        component.enter(0.0)
        component.exit()  # the reply may come before its files are missed

    with pytest.raises(TouchdownError, match=f"its FMU {said} in fmi2E"):
        initialise()


def test_a_lost_fmu_goes_on_saying_so(make: Make):
    component = IsolatedFmu("bearing", make("enter", "segv"), user_cache())
    for _ in range(2):
        with pytest.raises(TouchdownError, match="crashed with SIGSEGV in fmi2EnterInitializationMode"):
            component.enter(0.0)
    component.release(1)
    assert component.close() == ""


def test_a_child_that_holds_its_files_does_not_hide_its_end(make: Make):
    component = IsolatedFmu("bearing", make("enter", "orphan"), user_cache())
    with pytest.raises(TouchdownError, match="ended its process with status 0 in fmi2EnterInit"):
        component.enter(0.0)
    deadline = time.monotonic() + 60.0
    while alive_in(component._worker._process.pid):  # the child ends with it, as soon as it gets to run
        assert time.monotonic() < deadline


def alive_in(group: int) -> bool:
    """Whether a process of a group lives."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has ended meanwhile
            state, _, of = path.read_text().rpartition(") ")[2].split()[:3]
            if int(of) == group and state != "Z":
                return True
    return False


# -- what it says --------------------------------------------------------------------------------------


@pytest.mark.parametrize("isolate", [True, False])
@pytest.mark.parametrize(
    ("deed", "said"),
    [
        ("format", "component bearing: table: u = 1.25 is outside 0 .. 1"),
        ("odd", "component bearing: it answered -5, which is not a status of FMI, and gave no reason"),
    ],
)  # fmt: skip
def test_a_reason_has_its_numbers(deed: str, said: str, isolate: bool, make: Make):
    """The logger is a printf."""
    scene = load_scene(str(scene_with(make("step", deed)))).set({"bearing.isolate": isolate})
    with opened(scene, in_process=True) as system:
        assert simulate(scene, system).reason == f"{said} (while stepping from t = 4e-05 s)"


@pytest.mark.parametrize("isolate", [True, False])
@pytest.mark.parametrize(
    ("deed", "said"),
    [("thread", "its FMU warned once: iteration 7"), ("long", "its FMU warned 1000 times: 999")],
)
def test_warnings_are_said_once(deed: str, said: str, isolate: bool, make: Make, tmp_path: Path):
    """From whatever thread, without Python's lock; counted, and cut to a length."""
    scene = load_scene(str(scene_with(make("step", deed)))).set({"bearing.isolate": isolate})
    result = run_scene(scene, tmp_path / "out", in_process=True)
    assert result.warnings[-1].startswith(f"component bearing: {said}"[:50])
    assert len(result.warnings[-1]) < 300
    assert result.summary["components"]["bearing"]["warned"].startswith(said[:20])


def test_rounding_that_an_fmu_changes_is_its_own(make: Make):
    """It is stepped in a process of its own: what others compute is the same to the bit."""
    ends = []
    for deed in ("mind", "round"):
        scene = load_scene(str(scene_with(make("step", deed))))
        with opened(scene, in_process=True) as system:
            simulate(scene, system).raise_if_stopped()
            ends.append([system.value(f"rotor.A.{name}") for name in ("x", "y", "vy")])
    assert ends[0] == ends[1]


def test_what_an_fmu_says_without_end_takes_no_memory():
    """The last messages are kept, each with its place in the row, and a count for each category."""
    log, logger = (
        FmuLog(),
        ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 2, ctypes.c_int, *[ctypes.c_char_p] * 2),
    )
    say = logger(compiled().addresses["plain"])
    for number in range(100):
        say(
            log.address, None, 1 + number % 3, b"even" if number % 2 == 0 else None, f"{number} %s".encode()
        )
        say(log.address, None, 0, b"fine", b"nothing to keep")
    assert [message.text for message in log] == [f"{number} %s" for number in range(100 - KEPT, 100)]
    assert log.categories == {"even": 50, "": 50}


def test_a_short_message_ends_where_it_ends():
    """Also where a longer one stood before, and where there is none, or one that would write somewhere."""
    log, logger = (
        FmuLog(),
        ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 2, ctypes.c_int, *[ctypes.c_char_p] * 3),
    )
    say = logger(compiled().addresses["fmi2"])
    for _ in range(KEPT):
        say(log.address, None, 1, b"solver", b"a long message about %s", b"plants")
    for said in (b"%s", b"all of %n", None):
        say(log.address, None, 3, None, said, b"short")
    assert [message.text for message in log][-3:] == ["short", "all of %n", ""]
    assert [message.category for message in log][-3:] == [""] * 3


def test_what_is_logged_without_naming_the_instance_is_nobody_s():
    """FMI has an FMU hand back the environment that it was given; some hand over nothing."""
    say = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 2, ctypes.c_int, *[ctypes.c_char_p] * 2)
    for logger in ("fmi2", "plain"):
        say(compiled().addresses[logger])(None, None, 1, b"solver", b"a warning")


# -- in either -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("deed", "said", "isolate"),
    [
        ("end", "its FMU ended the simulation (while ", "true"),
        ("discard", "'discard' and gave no reason; it may not take", "false"),
    ],
)
def test_a_discarded_step_is_told_from_an_end(
    deed: str, said: str, isolate: str, make: Make, command: Command, tmp_path: Path
):
    trusted = ("--set", f"bearing.isolate={isolate}", *QUIET)
    ended = command("run", scene_with(make("step", deed)), *trusted, "-o", tmp_path / "out")
    assert said in ended.line
    assert "(while stepping from t = 4e-05 s)" in ended.line


@pytest.mark.parametrize(("entry", "kept"), [("resources/slavemodule.txt", False), ("binaries/a.so", True)])
def test_the_seal_knows_pythonfmu_where_it_made_the_fmu(
    entry: str, kept: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = build.write_fmu({entry: b"code"}, tmp_path, "sealed")
    assert build.is_sealed(path)
    assert not build.is_sealed(build.write_fmu({entry: b"code"}, tmp_path, "a user's", sealed=False))
    monkeypatch.setattr(build, "version", lambda name: "0")  # of pythonfmu
    assert build.is_sealed(path) is kept
