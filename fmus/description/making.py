"""Who made an FMU with what, and which FMU it is."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from xml.etree.ElementTree import Element, SubElement

from touchdown.fmus.version import RELEASED, VERSION
from touchdown.modelkit.kernel import source_hash
from touchdown.modelkit.model import Model


@dataclass(frozen=True)
class Making:
    """How an FMU is made, and what follows from that."""

    tool: str
    guid: str
    needs_tool: bool  # in its host


def by_pythonfmu(model: Model) -> Making:
    """The making of an FMU that is Python."""
    return Making(f"touchdown-cosim {VERSION}, PythonFMU {version('pythonfmu')}", guid(model), True)


def guid(model: Model) -> str:
    """Identity of a model's FMU: equal sources, equal GUID."""
    packages = ("modelkit", "rotor", "bearings", "fmus")
    digest = hashlib.sha256(
        f"{model.name} {model.content} {VERSION} {source_hash(packages)}".encode()
    ).hexdigest()
    return f"{digest[:8]}-{digest[8:12]}-{digest[12:16]}-{digest[16:20]}-{digest[20:32]}"


def identity(model: Model, making: Making) -> dict[str, str]:
    """What the FMU is, and who made it with what: attributes that both versions of FMI have."""
    return {
        "modelName": model.title,
        "description": model.about,
        "author": "touchdown-cosim",
        "license": "MIT",
        "version": VERSION,
        "generationTool": making.tool,
        "generationDateAndTime": RELEASED,
        "variableNamingConvention": "structured",
    }


def add_surroundings(root: Element, log_categories: Mapping[str, str]) -> None:
    """Categories of its log, and how long and by which steps it is tried."""
    categories = SubElement(root, "LogCategories")
    for name, meaning in log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": meaning})
    SubElement(root, "DefaultExperiment", {"startTime": "0.0", "stopTime": "0.1", "stepSize": "2e-05"})
