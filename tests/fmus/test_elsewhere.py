"""FMUs in hosts without Python, and what tells their users how: documentation, icon, `touchdown check`."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sysconfig
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from xml.etree.ElementTree import fromstring

import hosting
import pytest
from hosting import READ, Alone, drop, dropped_through_fmpy, numbers
from places import COMMAND

from touchdown.command.cli import main
from touchdown.fmus.presentation.documentation import page
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.common.errors import FAILED
from touchdown.master.interop import host_needs as needs
from touchdown.modelkit.kernel.cache_folder import user_cache
from touchdown.modelkit.model import slots

pytestmark = pytest.mark.slow
every_fmu = pytest.mark.parametrize("fmu", fmu_names())

# -- hosts without Python ----------------------------------------------------------------------------


def hosted(
    host: Path, folders: Path | Sequence[Path], commands: str, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Let the host do `commands` to the FMUs in `folders`, knowing nothing of this environment."""
    return hosting.hosted(
        host, folders, commands, "{}/resources", {"TOUCHDOWN_CACHE": str(user_cache()), **environment}
    )


@pytest.fixture(scope="module")
def preloaded() -> dict[str, str]:
    """The environment that `touchdown check` gives hosts without Python."""
    found = dict(word.split("=", 1) for word in shlex.split(needs.advice()) if "=" in word)
    if "LD_PRELOAD" not in found:
        pytest.skip(needs.advice())
    return found


def test_a_host_in_c_gets_the_same_numbers_to_the_last_bit(
    host: Path, unpacked: Mapping[str, Path], preloaded: dict[str, str], alone: Alone
):
    """A journal with given motion touches and leaves; a Python host steps the FMU through fmpy."""
    bushing = unpacked["bushing"]
    done = hosted(host, bushing, drop(bushing), **preloaded)
    assert done.returncode == 0, done.stderr
    found = numbers(done.stdout)
    assert found == dropped_through_fmpy(alone, bushing)
    force = found[READ.index("contact.force") :: len(READ)]
    assert force[0] == 0.0
    assert max(force) > 10.0
    assert force[-1] == 0.0


LIFE = "renew start step 0 1e-5 "


@pytest.mark.parametrize("commands", ["start step 0 1e-5 leave", "", f"{LIFE}{LIFE}"])
def test_a_host_in_c_ends_well(
    commands: str, host: Path, unpacked: Mapping[str, Path], preloaded: dict[str, str]
):
    """With the FMU freed or not; pythonfmu alone crashes three of four such processes."""
    with ThreadPoolExecutor(2) as pool:
        ended = list(pool.map(lambda _: hosted(host, unpacked["bushing"], commands, **preloaded), range(4)))
    assert [(done.returncode, done.stderr) for done in ended] == [(0, "")] * 4


COUNTED = """
import gc, json
from slave_driver import Slave
for k in range(5):
    slave = Slave(sys.argv[1]).start()
    slave.free()
scripts = [m.__dict__ for n, m in sys.modules.items() if n.startswith("bushing_")]
holders = sum(r is scripts[0] for o in gc.get_objects() for r in gc.get_referents(o))
print(json.dumps([len(scripts), holders, sys.getrefcount(scripts[0]) - 1]))
"""


def test_nothing_is_released_that_is_still_used(alone: Alone, unpacked: Mapping[str, Path]):
    """pythonfmu drops one reference to the script's globals for every instance, which it does not own.

    Where more hold them than are counted, the end of the interpreter frees them too early.
    """
    done = alone(COUNTED, unpacked["bushing"])
    assert done.returncode == 0, done.stderr
    scripts, holders, counted = json.loads(done.stdout)
    assert scripts == 1
    assert counted >= holders >= 2  # the module, and the list here


def test_a_failure_reaches_the_log_of_a_host_in_c(
    host: Path, unpacked: Mapping[str, Path], preloaded: dict[str, str]
):
    done = hosted(host, unpacked["bushing"], "start step 0 -1", **preloaded)
    assert done.returncode == 3
    assert "cannot step" in done.stderr


def test_packages_that_are_gone_are_named(
    host: Path, unpacked: Mapping[str, Path], preloaded: dict[str, str], tmp_path: Path
):
    """In the host's log, and on stderr for hosts that log nothing."""
    library = Path(sysconfig.get_path("stdlib"))
    bare = tmp_path / "lib" / library.name
    bare.mkdir(parents=True)
    for entry in library.iterdir():
        if entry.name not in ("site-packages", "dist-packages"):
            (bare / entry.name).symlink_to(entry)
    gone = {**preloaded, "PYTHONPATH": "/no/such/packages", "PYTHONHOME": str(tmp_path)}
    done = hosted(host, unpacked["bushing"], "start", PYTHONNOUSERSITE="1", **gone)
    assert done.returncode == 2
    own, logged, *_ = done.stderr.splitlines()
    assert own.startswith("touchdown: this FMU needs numpy")
    assert "does not find in /no/such/packages" in own
    assert logged.startswith("hosted: status 4:")
    assert own.removeprefix("touchdown: ") in done.stderr.split("status 4:")[1]


# -- documentation and icon --------------------------------------------------------------------------


@every_fmu
def test_documentation_names_every_variable(fmu: str, unpacked: Mapping[str, Path]):
    """Members of a group share a row, of which the first and the last are named."""
    text = (unpacked[fmu] / "documentation" / "index.html").read_text(encoding="utf-8")
    plain = {slot.variable.name for slot in slots(recipe(fmu).model) if "[" not in slot.variable.name}
    assert plain
    assert {name for name in plain if f"<td>{name}</td>" not in text} == set()
    for slot in slots(recipe(fmu).model):
        assert slot.variable.spec.meaning.split("'")[0].replace("<", "&lt;") in text


@every_fmu
def test_documentation_is_whole(fmu: str, unpacked: Mapping[str, Path]):
    """Each tag that is opened is closed, in order; and each part is there."""
    text = (unpacked[fmu] / "documentation" / "index.html").read_text(encoding="utf-8")
    root = fromstring(re.sub(r"<(meta|img|br)([^>]*)>", r"<\1\2/>", text.removeprefix("<!DOCTYPE html>\n")))
    headings = [element.text for element in root.iter("h2")]
    for needed in ("Validity", "What it needs", "Example", "Parameters", "Inputs", "Outputs"):
        assert needed in headings
    assert recipe(fmu).model.about in text


@pytest.mark.parametrize("fmu", ["bushing", "housing"])
def test_the_example_of_the_documentation_runs(
    fmu: str, alone: Alone, built: Mapping[str, Path], tmp_path: Path
):
    example = re.findall(r"<pre>(from fmpy.*?)</pre>", page(recipe(fmu)), re.DOTALL)
    assert len(example) == 1
    shutil.copy(built[fmu], tmp_path)
    done = alone(f"import os; os.chdir({str(tmp_path)!r})\n{example[0]}")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("(0.001")


# -- what a host needs ------------------------------------------------------------------------------


def test_this_machine_is_fit(capsys: pytest.CaptureFixture[str], preloaded: dict[str, str]):
    assert main(["check"]) == 0
    said = capsys.readouterr().out
    assert "MISSING" not in said
    libpython = preloaded["LD_PRELOAD"]
    for needed in ("numpy", "scipy", "numba compiles", str(user_cache()), libpython, "LD_PRELOAD="):
        assert needed in said


@pytest.mark.parametrize(
    ("name", "value", "named"),
    [
        ("TOUCHDOWN_CACHE", "{tmp}/file/cache", "cannot use "),
        ("NUMBA_DISABLE_JIT", "1", "unset NUMBA_DISABLE_JIT"),
    ],
)
def test_what_is_wrong_is_named(name: str, value: str, named: str, tmp_path: Path):
    """In a process of its own: numba reads its environment once."""
    (tmp_path / "file").write_text("in the way")
    done = subprocess.run(
        [*COMMAND, "check"],
        env={**os.environ, name: value.format(tmp=tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == FAILED
    assert [line for line in done.stdout.splitlines() if "MISSING" in line and named in line]
    assert done.stderr.count("touchdown: warning: cannot use the cache") == done.stderr.count("\n")
