"""terminalsAndIcons/ of every FMU: valid by FMI 3.0's schema, true, and with its pictures."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import fmpy
import pytest
from lxml import etree

from touchdown.fmus.recipes import fmu_names

SCHEMA = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"
PORTS = {"bushing": ["journal", "housing"], "amb": ["journal", "housing", "sensor"], "housing": ["seat"]}


@pytest.fixture(scope="module")
def terminals(unpacked: Mapping[str, Path]) -> Mapping[str, etree._Element]:
    """The roots of all of them."""
    folders = {name: folder / "terminalsAndIcons" for name, folder in unpacked.items()}
    return {
        name: etree.parse(str(folder / "terminalsAndIcons.xml")).getroot()
        for name, folder in folders.items()
    }


@pytest.mark.parametrize("fmu", fmu_names())
def test_it_is_valid_and_members_are_variables_of_the_fmu(
    fmu: str, terminals: Mapping[str, etree._Element], unpacked: Mapping[str, Path]
):
    schema = etree.XMLSchema(file=str(SCHEMA))
    assert schema.validate(terminals[fmu]), schema.error_log
    description = fmpy.read_model_description(str(unpacked[fmu]))
    known = {v.name for v in description.modelVariables}
    for terminal in terminals[fmu].iter("Terminal"):
        members = {
            m.get("variableName"): m.get("memberName") for m in terminal.iter("TerminalMemberVariable")
        }
        assert set(members) <= known
        assert all(name == f"{terminal.get('name')}.{member}" for name, member in members.items())


def test_every_port_is_a_terminal(terminals: Mapping[str, etree._Element]):
    for fmu, ports in PORTS.items():
        assert [t.get("name") for t in terminals[fmu].iter("Terminal")] == ports


def test_what_belongs_together_has_one_name(terminals: Mapping[str, etree._Element]):
    """A bearing's journal and a rotor's seat name the same members, but for what holds a rotor at rest.

    Those of a planar bearing are a part of them.
    """

    def members(fmu: str, port: str) -> set[str]:
        (terminal,) = (t for t in terminals[fmu].iter("Terminal") if t.get("name") == port)
        return {m.get("memberName") for m in terminal.iter("TerminalMemberVariable")}

    held = {"static_fx", "static_fy", "static_fz"}
    assert members("rotor_I", "A") ^ members("landing_sleeve", "journal") == held
    assert members("housing", "seat") == members("landing_sleeve", "housing")
    assert members("bushing", "journal") < members("landing_sleeve", "journal")
    assert members("bushing", "housing") < members("landing_sleeve", "housing")
