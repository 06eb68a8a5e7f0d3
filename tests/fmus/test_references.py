"""Experiments and parameter sets in every FMU, by FMI-LS-REF: small, whole, and met by other hosts."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from fmpy import read_csv, simulate_fmu
from lxml import etree

from touchdown.fmus.build import build
from touchdown.fmus.presentation.references import FOLDER, STEP, STEPS, TOLERANCE
from touchdown.fmus.recipes import names, recipe

LARGEST = 100_000  # bytes
every_fmu = pytest.mark.parametrize("fmu", names())


@every_fmu
def test_the_manifest_names_what_is_there(fmu: str, unpacked: Mapping[str, Path]):
    folder = unpacked[fmu] / FOLDER
    manifest = fromstring((folder / "fmi-ls-manifest.xml").read_bytes())
    space = "{http://fmi-standard.org/fmi-ls-manifest}fmi-ls-"
    assert manifest.tag == "fmiReferences"
    assert manifest.attrib[f"{space}name"] == "org.fmi-standard.fmi-ls-ref"
    assert manifest.attrib[f"{space}version"] == "1.0.0-alpha.1"
    named = [related.attrib["source"] for related in manifest]
    assert {"default.ssv", "smoke-test.exp", "results.csv"} <= set(named)
    assert {*named, "stimuli.csv", "fmi-ls-manifest.xml"} == {path.name for path in folder.iterdir()}
    assert sum(path.stat().st_size for path in folder.iterdir()) < LARGEST


def test_bearings_bring_the_catalogue_along(unpacked: Mapping[str, Path]):
    text = (unpacked["simplified_caged"] / FOLDER / "6014.ssv").read_text(encoding="utf-8")
    assert '<ssv:Parameter name="balls.count">\n      <ssv:Integer value="11" />' in text
    assert not (unpacked["bushing"] / FOLDER / "6014.ssv").exists()


@every_fmu
def test_something_happens_in_the_experiment(fmu: str, unpacked: Mapping[str, Path]):
    results = read_csv(str(unpacked[fmu] / FOLDER / "results.csv"))
    assert len(results) == STEPS + 1
    assert np.allclose(results["time"], STEP * np.arange(STEPS + 1), rtol=0.0, atol=1e-15)
    moved = [name for name in results.dtype.names[1:] if np.ptp(results[name]) > 0.0]
    assert len(moved) >= 4
    if "journal.fy" in results.dtype.names and fmu not in (
        "amb",
        "amb_actuator",
    ):  # pressed, and parted at both ends
        assert np.max(np.abs(results["journal.fy"])) > 1.0
        assert results["journal.fy"][0] == 0.0


@pytest.mark.parametrize("fmu", ["bushing", "rigid_rotor"])
def test_fmpy_finds_the_results(fmu: str, built: Mapping[str, Path], unpacked: Mapping[str, Path]):
    """Another host, which runs in processes of its own the experiment that it read from the files."""
    folder = unpacked[fmu] / FOLDER
    expected = read_csv(str(folder / "results.csv"))
    found = simulate_fmu(
        str(built[fmu]),
        stop_time=STEP * STEPS,
        step_size=STEP,
        output_interval=STEP,
        input=read_csv(str(folder / "stimuli.csv")),
        output=list(expected.dtype.names[1:]),
    )
    for name in expected.dtype.names[1:]:
        off = np.max(np.abs(found[name] - expected[name]))
        assert off <= TOLERANCE * np.max(np.abs(expected[name])), name


def test_other_start_values_have_other_results(tmp_path: Path):
    """An FMU of a package starts from its scene's values, and so do its results."""
    changed = recipe("bushing").starting_from({"clearance": 2e-4})
    with zipfile.ZipFile(build(changed, tmp_path)) as archive:
        stimuli = archive.read(f"{FOLDER}/stimuli.csv").decode()
        values = archive.read(f"{FOLDER}/default.ssv").decode()
    first = dict(zip(*(line.split(",") for line in stimuli.splitlines()[:2]), strict=True))
    assert float(first["journal.y"]) == pytest.approx(-1.99e-4)
    assert 'name="clearance">\n      <ssv:Real value="0.0002"' in values


def test_what_cannot_start_comes_without_an_experiment(tmp_path: Path):
    changed = recipe("bushing").starting_from({"clearance": -1.0})
    with zipfile.ZipFile(build(changed, tmp_path)) as archive:
        held = {name.rpartition("/")[2] for name in archive.namelist() if name.startswith(FOLDER)}
        manifest = etree.parse(io.BytesIO(archive.read(f"{FOLDER}/fmi-ls-manifest.xml"))).getroot()
    assert held == {"default.ssv", "fmi-ls-manifest.xml"}
    assert [related.get("source") for related in manifest] == ["default.ssv"]
