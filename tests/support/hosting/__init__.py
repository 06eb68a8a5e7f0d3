"""A host in C, which knows no Python, and a journal that drops into a bearing through it."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from xml.etree.ElementTree import fromstring

from places import SUPPORT

Alone = Callable[..., subprocess.CompletedProcess[str]]

COMPILER = shutil.which("cc") or shutil.which("gcc")
STEPS, STEP = 150, 2e-5  # s; the journal touches the bore of 0.3 mm in the middle of it
READ = (
    "journal.fx",
    "journal.fy",
    "journal.mz",
    "contact.force",
    "contact.peak_force",
    "contact.first_time",
)
_DROPPED = """
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


def compiled(folder: Path) -> Path:
    """The host, made with the system's compiler."""
    assert COMPILER is not None
    path, source = folder / "host", SUPPORT / "hosting" / "host.c"
    subprocess.run([COMPILER, "-Wall", "-Wextra", "-Werror", "-o", path, source, "-ldl"], check=True)
    return path


def hosted(
    host: Path,
    folders: Path | Sequence[Path],
    commands: str,
    resources: str,
    environment: Mapping[str, str],
) -> subprocess.CompletedProcess[str]:
    """Let the host do `commands` to the FMUs in `folders`, in no other than this environment.

    `resources` is the folder's URI with `{}` for that of the FMU.
    """
    folders = [folders] if isinstance(folders, Path) else folders
    return subprocess.run(
        [host, *(word for folder in folders for word in _named(folder, resources))],
        input=commands,
        env=dict(environment),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def _named(folder: Path, resources: str) -> tuple[str, str, str]:
    """Library, GUID and resources of an unpacked FMU."""
    guid = fromstring((folder / "modelDescription.xml").read_bytes()).attrib["guid"]
    library = next((folder / "binaries" / "linux64").glob("*.so"))
    return str(library), guid, resources.format(folder.as_uri())


def references(folder: Path) -> dict[str, str]:
    """Value references by name."""
    xml = fromstring((folder / "modelDescription.xml").read_bytes())
    return {v.attrib["name"]: v.attrib["valueReference"] for v in xml.iter("ScalarVariable")}


def _motion(k: int) -> dict[str, float]:
    """Motion of a journal at macro step k: it falls, drifts, touches, and is taken back."""
    t = k * STEP
    return {
        "journal.x": 0.02 * t,
        "journal.vx": 0.02,
        "journal.y": -0.32e-3 * math.sin(math.pi * k / STEPS),
        "journal.vy": -0.32e-3 * math.pi / (STEPS * STEP) * math.cos(math.pi * k / STEPS),
        "journal.omega": 900.0,
    }


def drop(folder: Path) -> str:
    """The host's commands that drop the journal into the bearing in `folder`, and read it at every step."""
    known = references(folder)
    lines = ["start"]
    for k in range(STEPS):
        lines += [f"set {known[name]} {value.hex()}" for name, value in _motion(k).items()]
        lines += [f"step {(k * STEP).hex()} {STEP.hex()}"]
        lines += [f"get {known[name]}" for name in READ]
    return "\n".join(lines)


def dropped_through_fmpy(alone: Alone, folder: Path) -> list[float]:
    """What the FMU in `folder` gives in the same drop, stepped through fmpy in a process of its own."""
    rows = json.dumps([_motion(k) for k in range(STEPS)])
    done = alone(_DROPPED, folder, rows, STEP, json.dumps(READ))
    assert done.returncode == 0, done.stderr
    return numbers(done.stdout)


def numbers(text: str) -> list[float]:
    """Hexadecimal ones, to the last bit."""
    return [float.fromhex(word) for word in text.split()]
