"""SSP packages for tools that cannot connect calculated parameters."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pytest
from archives import entries_of

from touchdown.command.cli import main
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.interop.ssp.xml import NAMESPACES, SSD_FILE
from touchdown.master.scene.scene import Scene

CONSTANTS = {
    *("inv_m", "inv_I", "k_over_m", "c_over_m", "static_fx", "static_fy", "static_fz"),
    *("inv_m_z", "inv_I_t", "inv_mI"),
}


def structure(package: Path) -> Element:
    """SystemStructure.ssd of a package."""
    return fromstring(entries_of(package)[SSD_FILE])


def connected(root: Element) -> set[str]:
    """Last parts of the names of connected inputs."""
    found = root.iter(f"{{{NAMESPACES['ssd']}}}Connection")
    return {c.attrib["endConnector"].rpartition(".")[2] for c in found}


def started(root: Element) -> dict[str, float]:
    """Start values of the bearing."""
    bearing = next(
        c for c in root.iter(f"{{{NAMESPACES['ssd']}}}Component") if c.attrib["name"] == "bearing"
    )
    found = bearing.iter(f"{{{NAMESPACES['ssv']}}}Parameter")
    return {p.attrib["name"]: float(p[0].attrib["value"]) for p in found}


def test_constants_are_start_values_instead(tmp_path: Path) -> None:
    scene = find_scene("disk-caged-simplified")
    whole = structure(write_ssp(scene, tmp_path / "whole.ssp").path)
    outputs = structure(write_ssp(scene, tmp_path / "outputs.ssp", outputs_only=True).path)
    assert connected(whole) - connected(outputs) == CONSTANTS
    kinds = {c.attrib["kind"] for c in outputs.iter(f"{{{NAMESPACES['ssd']}}}Connector")}
    assert kinds == {"input", "output", "parameter"}
    assert started(outputs) == started(whole)
    assert started(outputs)["journal.inv_m"] == pytest.approx(1.0 / 1.65)


def landed(scene: Scene) -> list[float]:
    """Journal and peak force just after the first impact."""
    system = open_system(scene)
    try:
        simulate(scene, system)
        return [system.value(name) for name in ("rotor.A.x", "rotor.A.y", "bearing.contact.peak_force")]
    finally:
        system.close()


def test_it_runs_like_the_scene(tmp_path: Path) -> None:
    scene = find_scene("disk-caged-simplified").set({"amb.shutdown_time": 2e-3, "run.duration": 9e-3})
    found = landed(find_scene(str(write_ssp(scene, tmp_path / "disk.ssp", outputs_only=True).path)))
    assert found == landed(scene)
    assert found[-1] > 300.0


def test_the_command_writes_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    package = tmp_path / "disk.ssp"
    scheme = ["--set", "run.scheme=jacobi-lead", "--outputs-only"]
    assert main(["ssp", "disk-caged-simplified", *scheme, "-o", str(package)]) == 0
    assert "4 components, 54 connections" in capsys.readouterr().out
    assert started(structure(package))["interface.lead"] == 1.0
