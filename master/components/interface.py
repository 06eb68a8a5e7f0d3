"""What an FMU says of itself: whether it can be co-simulated here, its variables and units."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fmpy import platform as fmi_platform
from fmpy import read_model_description, sharedLibraryExtension

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import BASE, Unit
from touchdown.master.components.binary import refuse_damaged
from touchdown.master.components.component import Kind, Variable
from touchdown.master.components.description import refuse_definitions, refuse_lies
from touchdown.master.components.unpack import unpack
from touchdown.modelkit.variables import Causality, Variability

SHOWN = 5  # files named where one is missing


def describe(path: Path, folder: Path) -> Any:
    """fmpy's model description of an unpacked FMU that can be co-simulated here."""
    try:
        refuse_definitions(folder / "modelDescription.xml")
        description = read_model_description(str(folder), validate=False)
    except Exception as error:
        first = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
        raise TouchdownError(f"{path}: cannot read its modelDescription.xml ({first})") from None
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        kind = "co-simulation" if description.coSimulation else "model exchange only"
        raise TouchdownError(
            f"{path} is FMI {description.fmiVersion}, {kind}; FMI 2.0 for co-simulation is needed"
        )
    identifier = description.coSimulation.modelIdentifier
    refuse_lies(path, description)
    library = folder / "binaries" / fmi_platform / f"{identifier}{sharedLibraryExtension}"
    if not library.is_file():
        raise TouchdownError(
            f"{path} has no binary for this platform ({fmi_platform}): it lacks {_held(library, folder)}"
        )
    refuse_damaged(path, library)
    if by_pythonfmu(description):
        _check_script(path, folder)
    return description


def _held(library: Path, folder: Path) -> str:
    """Where the `library` of an FMU that is unpacked in `folder` should be, and which it has instead."""
    held = sorted(str(p.relative_to(folder)) for p in (folder / "binaries").rglob("*") if p.is_file())
    first = ", ".join(held[:SHOWN]) + (f" and {len(held) - SHOWN} more" if len(held) > SHOWN else "")
    return f"{library.relative_to(folder)}, and has {first or 'none'}"


def by_pythonfmu(description: Any) -> bool:
    """Whether an FMU was made by pythonfmu."""
    return "PythonFMU" in (description.generationTool or "")


def _check_script(path: Path, folder: Path) -> None:
    """pythonfmu's library ends the process where the script it is to run is missing."""
    name = folder / "resources" / "slavemodule.txt"
    module = name.read_bytes().decode("utf-8", "replace").strip() if name.is_file() else ""
    if not module.isidentifier() or not (name.parent / f"{module}.py").is_file():
        raise TouchdownError(f"{path} is damaged: it lacks the script that resources/slavemodule.txt names")


def variables_of(description: Any) -> dict[str, Variable]:
    """Variables by name."""

    def number(text: object) -> float | None:
        try:
            return None if text is None else float(str(text))
        except ValueError:
            return None

    return {
        v.name: Variable(
            name=v.name,
            reference=v.valueReference,
            kind=Kind(v.type),
            causality=Causality(v.causality or Causality.LOCAL),
            variability=Variability(v.variability or Variability.CONTINUOUS),
            unit=(v.unit or (v.declaredType.unit if v.declaredType else None))
            if v.type == Kind.REAL
            else "1",
            minimum=number(v.min),
            maximum=number(v.max),
            start=number(v.start),
            description=v.description or "",
        )
        for v in description.modelVariables
    }


def units_of(description: Any) -> dict[str, Unit]:
    """Units that the description defines by SI base units, by name."""
    units: dict[str, Unit] = {}
    for unit in description.unitDefinitions:
        base = unit.baseUnit
        if base is not None:
            exponents = {symbol: getattr(base, symbol) for symbol in BASE if getattr(base, symbol)}
            units[unit.name] = Unit(exponents, float(base.factor), float(base.offset))
    return units


def interface(path: Path, cache: Path) -> tuple[dict[str, Variable], dict[str, Unit]]:
    """Variables and units of an FMU, which is not loaded."""
    description = describe(path, unpack(path, cache))
    return variables_of(description), units_of(description)
