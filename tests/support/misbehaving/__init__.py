"""FMUs that misbehave, made of bearing.c."""

from __future__ import annotations

import shutil
import subprocess
import zipfile
from pathlib import Path

from places import SUPPORT

COMPILER = shutil.which("cc") or shutil.which("gcc")
ENDINGS = ("exit", "_exit", "abort", "segv", "hang")
CALLS = ("instantiate", "setup", "enter", "leave", "step", "terminate", "free")
DEEDS = [
    *((call, deed) for call in CALLS for deed in ENDINGS),
    *(("set", "exit"), ("get", "_exit"), ("step", "error"), ("enter", "fatal"), ("step", "nan")),
]
CHECKED = [  # every ending, calls of every phase
    *(("instantiate", "exit"), ("set", "abort"), ("leave", "segv"), ("step", "hang"), ("free", "_exit")),
    *(("step", "error"), ("enter", "fatal"), ("step", "nan")),
]
FMI = {  # what a call is called
    "instantiate": "fmi2Instantiate",
    "setup": "fmi2SetupExperiment",
    "enter": "fmi2EnterInitializationMode",
    "leave": "fmi2ExitInitializationMode",
    "set": "fmi2SetReal",
    "get": "fmi2GetReal",
    "step": "fmi2DoStep",
    "terminate": "fmi2Terminate",
    "free": "fmi2FreeInstance",
}
VARIABLES = (
    ("x", "input", "m"),
    ("y", "input", "m"),
    ("fx", "output", "N"),
    ("fy", "output", "N"),
    ("work", "output", "J"),
    ("jump", "output", "J"),
)
UNITS = {"m": 'm="1"', "N": 'kg="1" m="1" s="-2"', "J": 'kg="1" m="2" s="-2"'}
SCENE = """
attach = [["bearing.journal", "rotor.A"]]
[run]
duration = "2 ms"
record_every = 1
warn_residual = 1e9
stop_residual = 1e9
call_timeout = "{patience}"
[components.rotor]
fmu = "rigid_rotor"
[components.rotor.set]
mass = "2 kg"
speed = 0
[components.bearing]
fmu = "{fmu}"
"""


def patience(fmu: Path) -> str:
    """What each of its calls may take: little only where one never ends, so that no other is late."""
    return "1 s" if "hang" in fmu.stem else "60 s"


def description() -> str:
    """Its modelDescription.xml."""
    units = [f'<Unit name="{unit}"><BaseUnit {base}/></Unit>' for unit, base in UNITS.items()]
    start = {"input": ' start="0"', "output": ""}
    variables = [
        f'<ScalarVariable name="journal.{name}" valueReference="{k}" causality="{causality}">'
        f'<Real unit="{unit}"{start[causality]}/></ScalarVariable>'
        for k, (name, causality, unit) in enumerate(VARIABLES)
    ]
    given = [
        f'<Unknown index="{k}"/>' for k, variable in enumerate(VARIABLES, 1) if variable[1] == "output"
    ]
    return (
        '<fmiModelDescription fmiVersion="2.0" modelName="misbehaving" guid="0" '
        'variableNamingConvention="structured">'
        '<CoSimulation modelIdentifier="misbehaving" canHandleVariableCommunicationStepSize="true"/>'
        f"<UnitDefinitions>{''.join(units)}</UnitDefinitions>"
        f"<ModelVariables>{''.join(variables)}</ModelVariables>"
        f"<ModelStructure><Outputs>{''.join(given)}</Outputs>"
        f"<InitialUnknowns>{''.join(given)}</InitialUnknowns></ModelStructure></fmiModelDescription>"
    )


def compiled(folder: Path) -> Path:
    """The library."""
    assert COMPILER is not None
    path = folder / "misbehaving.so"
    options = ("-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-fvisibility=hidden", "-pthread")
    subprocess.run([COMPILER, *options, "-o", path, SUPPORT / "misbehaving" / "bearing.c"], check=True)
    return path


def misbehaving(library: Path, call: str, deed: str) -> Path:
    """An FMU that does `deed` in `call`."""
    path = library.with_name(f"{call}-{deed}.fmu")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description())
        archive.writestr("resources/how.txt", f"{call} {deed}\n")
        archive.write(library, "binaries/linux64/misbehaving.so")
    return path


def scene_with(fmu: Path) -> Path:
    """A scene, beside the FMU, of a disk on it."""
    path = fmu.with_suffix(".toml")
    path.write_text(SCENE.format(fmu=fmu.name, patience=patience(fmu)), encoding="utf-8")
    return path
