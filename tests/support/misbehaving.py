"""FMUs that misbehave, made of misbehaving.c."""

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
DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="misbehaving" guid="0" variableNamingConvention="structured">
<CoSimulation modelIdentifier="misbehaving" canHandleVariableCommunicationStepSize="true"/>
<UnitDefinitions>
<Unit name="m"><BaseUnit m="1"/></Unit><Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
</UnitDefinitions>
<ModelVariables>
<ScalarVariable name="journal.x" valueReference="0" causality="input"><Real unit="m" start="0"/></ScalarVariable>
<ScalarVariable name="journal.y" valueReference="1" causality="input"><Real unit="m" start="0"/></ScalarVariable>
<ScalarVariable name="journal.fx" valueReference="2" causality="output"><Real unit="N"/></ScalarVariable>
<ScalarVariable name="journal.fy" valueReference="3" causality="output"><Real unit="N"/></ScalarVariable>
</ModelVariables>
<ModelStructure>
<Outputs><Unknown index="3"/><Unknown index="4"/></Outputs>
<InitialUnknowns><Unknown index="3"/><Unknown index="4"/></InitialUnknowns>
</ModelStructure>
</fmiModelDescription>
"""


def compiled(folder: Path) -> Path:
    """The library."""
    assert COMPILER is not None
    path = folder / "misbehaving.so"
    options = ("-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-fvisibility=hidden")
    subprocess.run([COMPILER, *options, "-o", path, SUPPORT / "misbehaving.c"], check=True)
    return path


def misbehaving(library: Path, call: str, deed: str) -> Path:
    """An FMU that does `deed` in `call`."""
    path = library.with_name(f"{call}-{deed}.fmu")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION)
        archive.writestr("resources/how.txt", f"{call} {deed}\n")
        archive.write(library, "binaries/linux64/misbehaving.so")
    return path
