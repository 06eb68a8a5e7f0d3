"""Terminals and icons: which variables belong to one port, and pictures to draw them with.

FMI 3.0 defines it (2.4.9), and FMI 2.0 takes it over from its release 2.0.4 on. Tools that know it connect
a bearing with a journal by one line instead of thirty: members of one name belong together.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ...modelkit.model import Model, Slot
from ...modelkit.variables import Causality
from ..description.described_variables import causality
from .icon import dot, icon


def document(root: Element) -> bytes:
    """A file with `root` in it, in its own layout."""
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root) + b"\n"


FOLDER = "terminalsAndIcons"
PORT_ICON = "port"
SIZE, PORT = 100.0, 12.0  # half the width of the drawing, and of a port in it
_CROSSING = (Causality.INPUT, Causality.OUTPUT, Causality.CALCULATED_PARAMETER)


def terminal_entries(model: Model, variables: Mapping[str, Slot]) -> dict[str, bytes]:
    """The folder's files by their names in the FMU of `model`, which exposes `variables` by name."""
    return {
        f"{FOLDER}/terminalsAndIcons.xml": _xml(port_members(variables)),
        f"{FOLDER}/icon.png": icon(model),
        f"{FOLDER}/{PORT_ICON}.png": dot(),
    }


def port_members(variables: Mapping[str, Slot]) -> dict[str, list[str]]:
    """Members of each port: all that have a position x and y, or takes a force fx and fy."""
    found: dict[str, list[str]] = {}
    for name, slot in variables.items():
        port, _, member = name.partition(".")
        if member and causality(slot)[0] in _CROSSING:
            found.setdefault(port, []).append(member)
    kinds = ({"x", "y"}, {"fx", "fy"})
    return {port: members for port, members in found.items() if any(k <= set(members) for k in kinds)}


def _xml(found: Mapping[str, list[str]]) -> bytes:
    root = Element("fmiTerminalsAndIcons", {"fmiVersion": "3.0"})
    picture = SubElement(root, "GraphicalRepresentation")
    SubElement(picture, "CoordinateSystem", {**_corners(0.0, SIZE), "suggestedScalingFactorTo_mm": "0.1"})
    SubElement(picture, "Icon", _corners(0.0, SIZE))
    if found:
        _add_terminals(root, found)
    indent(root)
    return document(root)


def _add_terminals(root: Element, found: Mapping[str, list[str]]) -> None:
    """The ports, one below the other."""
    terminals = SubElement(root, "Terminals")
    for i, (port, members) in enumerate(found.items()):
        terminal = SubElement(terminals, "Terminal", {"name": port, "matchingRule": "bus"})
        for member in members:
            SubElement(
                terminal,
                "TerminalMemberVariable",
                {"variableName": f"{port}.{member}", "memberName": member, "variableKind": "signal"},
            )
        height = SIZE - (2.0 * i + 1.0) * SIZE / len(found)  # of the port at the left edge
        place = {**_corners(height, PORT), "iconBaseName": PORT_ICON}
        SubElement(terminal, "TerminalGraphicalRepresentation", place)


def _corners(height: float, half: float) -> dict[str, str]:
    """A square: the whole drawing, or a port at the left edge of it at some height."""
    middle = 0.0 if half == SIZE else -SIZE
    return {
        "x1": f"{middle - half:g}",
        "y1": f"{height - half:g}",
        "x2": f"{middle + half:g}",
        "y2": f"{height + half:g}",
    }
