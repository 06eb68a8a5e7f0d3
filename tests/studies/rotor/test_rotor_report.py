"""Rotors described: `touchdown rotor`, its pictures, and what it answers to mistakes."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgba

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.reports.figures.style import sheet
from touchdown.rotor.beams.beam_body import PointMass
from touchdown.rotor.file import rotor_named, shipped_rotors
from touchdown.rotor.properties import RotorProperties, rotor_properties
from touchdown.studies.rotor.figure import DISC, campbell, critical, draw_rest, drawing, modes
from touchdown.studies.rotor.rotor_report import TO_REST, report, report_text

SPEED = math.pi * 600.0  # rad/s, 18000 rpm
PLAIN = """
title = "Plain shaft"
[material.steel]
modulus = "207 GPa"
density = "7830 kg/m3"
poisson = 0.3
[[element]]
length = "50 mm"
count = 8
outer_diameter = "20 mm"
inner_diameter = "8 mm"
"""


@pytest.fixture(scope="module", params=sorted(shipped_rotors()))
def found(request: pytest.FixtureRequest) -> RotorProperties:
    """What is known of each shipped rotor."""
    return rotor_properties(rotor_named(request.param), 5, [SPEED, 0.0, 0.5 * SPEED, SPEED, 2.0 * SPEED])


def shaft_file(folder: Path, rest_of_it: str) -> Path:
    path = folder / "plain.toml"
    path.write_text(PLAIN + rest_of_it, encoding="utf-8")
    return path


def test_a_free_rotor_s_lines_start_at_the_frequencies_at_rest_and_split(found: RotorProperties) -> None:
    assert found.kinds == ("translation", "tilt", "bending 1", "bending 2", "bending 3")
    assert found.forward[1] == pytest.approx(found.frequencies, abs=1e-3)
    assert found.backward[1] == pytest.approx(found.frequencies, abs=1e-3)
    assert (np.diff(found.forward[1:, 1:], axis=0) > 0.0).all()
    assert (np.diff(found.backward[1:, 2:], axis=0) < 0.0).all()
    np.testing.assert_allclose(found.forward[0], found.forward[3])
    ratio = found.shaft.polar_inertia / found.shaft.diametral_inertia
    assert found.forward[0, 1] == pytest.approx(300.0 * ratio, rel=1e-2)  # it tilts by them
    assert not found.backward[:, 1].any()
    assert not found.forward[:, 0].any()
    other = rotor_properties(found.shaft, 5, [-SPEED])  # the sense of the spin does not matter
    np.testing.assert_allclose(other.forward[0], found.forward[0])
    np.testing.assert_allclose(other.backward[0], found.backward[0])


def test_a_support_that_would_have_to_pull_is_said(tmp_path: Path) -> None:
    """Seats at 100 and 150 mm of a shaft of 400 mm, of which 200 mm are the middle: 2 G up, G down."""
    path = shaft_file(tmp_path, "[stations]\nA = 3\nB = 4\n")
    shaft = rotor_named(str(path))
    text = report_text(rotor_properties(shaft, 5, [SPEED]))
    assert f"  A would have to pull the rotor down with {9.81 * shaft.mass:.4g} N: " in text
    assert "B would have to pull" not in text
    path = shaft_file(tmp_path, "[stations]\nA = 1\nB = 9\n")
    assert "pull" not in report_text(rotor_properties(rotor_named(str(path)), 5, [SPEED]))


def test_the_table_tells_all(found: RotorProperties) -> None:
    text, shaft = report_text(found), found.shaft
    assert text.startswith(f"{shaft.title}\n")
    for label, value in (
        ("mass", shaft.mass),
        ("centre of mass", 1e3 * shaft.centre_of_mass),
        ("polar inertia", shaft.polar_inertia),
        ("diametral inertia", shaft.diametral_inertia),
        ("elements", len(shaft.elements)),
        ("nodes", shaft.nodes),
    ):
        row = re.search(rf"^  {label} +([\d.]+)", text, re.MULTILINE)
        assert row, label
        assert float(row[1]) == pytest.approx(value, rel=1e-4)
    for place in (*shaft.stations, *shaft.sensors):
        at = 1e3 * shaft.positions()[place.node - 1]
        assert re.search(rf"^  {place.name} .* {place.node} +{at:.1f}$", text, re.MULTILINE)
    assert "at 18000 rpm" in text
    for k, kind in enumerate(found.kinds):
        values = (found.frequencies[k], found.backward[0, k], found.forward[0, k])
        row = " +".join([kind, *(re.escape(f"{value:.2f}") for value in values)])
        assert re.search(rf"^  {row}$", text, re.MULTILINE)
    assert found.rest is not None
    assert f"A {found.rest.reactions[0]:.4g} N, B {found.rest.reactions[1]:.4g} N" in text


def test_diagrams_show_what_was_found(found: RotorProperties) -> None:
    """Over the speed, at rest, and over the stiffness of supports, with labels and units."""
    (axes,) = campbell(sheet(), found)
    assert axes.get_xlabel() == "rotor speed [rpm]"
    assert axes.get_ylabel() == "whirl frequency of the free rotor [Hz]"
    lines = {line.get_label(): line for line in axes.lines}
    once = lines["1x, once per turn"]
    np.testing.assert_allclose(once.get_ydata(), np.asarray(once.get_xdata()) / 60.0)
    np.testing.assert_allclose(lines["bending 1, forward"].get_ydata(), found.forward[1:, 2])
    np.testing.assert_allclose(lines["bending 1, backward"].get_ydata(), found.backward[1:, 2])
    assert "18000 rpm" in lines
    assert found.rest is not None
    view, deflection, bending = draw_rest(sheet(), found)
    labels = ["radius [mm]", "deflection, upwards [µm]", "bending stress [MPa]"]
    assert [one.get_ylabel() for one in (view, deflection, bending)] == labels
    np.testing.assert_allclose(deflection.lines[0].get_ydata(), 1e6 * found.rest.deflection)
    np.testing.assert_allclose(bending.lines[0].get_ydata(), 1e-6 * found.rest.bending)
    for axes, own, at in zip(
        critical(sheet(), found), found.critical, ("amb_A, amb_B", "A, B"), strict=True
    ):
        assert re.fullmatch(rf"stiffness of each support at {at}(, collar)? \[N/m\]", axes.get_xlabel())
        assert axes.get_ylabel() == "critical speed, forward [rpm]"
        assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
        np.testing.assert_allclose(axes.lines[0].get_ydata(), 30.0 / math.pi * own.speeds[:, 0])


def test_the_modes_stand_over_the_rotor_to_scale(found: RotorProperties) -> None:
    figure = sheet()
    modes(figure, found)
    figure.draw_without_rendering()
    assert len(figure.axes) == 5
    shaft = found.shaft
    sleeves = sum(e.sleeve_diameter > 0.0 for e in shaft.elements)
    for axes in figure.axes:
        assert axes.get_ylabel() == "radius [mm]"
        assert len(axes.patches) == len(shaft.elements) + sleeves + len(shaft.points)
        box = axes.get_window_extent()
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        assert (right - left) / box.width == pytest.approx((high - low) / box.height, rel=1e-3)
        assert high > 500.0 * max(max(e.outer_diameter, e.sleeve_diameter) for e in shaft.elements)
    assert figure.axes[-1].get_xlabel() == "position along the rotor's axis [mm]"
    assert "bending 1, " in figure.axes[2].get_title()


def test_the_command_describes_all_rotors(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rotor", "-o", str(tmp_path), "--speed", "-12000 rpm", "--modes", "3"]) == 0
    text = capsys.readouterr().out
    assert "Rotor I\n" in text
    assert "Rotor II\n" in text
    assert "at 12000 rpm" in text
    assert "bending 1" in text
    assert "bending 2" not in text
    for name in shipped_rotors():
        for picture in ("campbell", "modes", "rest"):
            assert (tmp_path / name / f"{picture}.png").read_bytes().startswith(b"\x89PNG")


def test_two_rotors_of_one_name_keep_their_pictures_apart(tmp_path: Path) -> None:
    """Folders are called after the files; two of one name are refused before anything is drawn.

    So is a broken file, in one line.
    """
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        shaft_file(tmp_path / folder, "")
    files = [str(tmp_path / folder / "plain.toml") for folder in ("one", "two")]
    assert main(["rotor", *files, "-o", str(tmp_path / "out")]) == FAILED
    assert not (tmp_path / "out").exists()
    broken = shaft_file(tmp_path / "one", "[stations]\nA = 99\n")
    with pytest.raises(TouchdownError, match=r"plain\.toml: stations\.A = 99 is not a node") as caught:
        report(str(broken), tmp_path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "stations", ["", 'levitated_at = ["amb"]\n[stations]\nA = 2\namb = 5\n', "[stations]\nA = 2\nB = 2\n"]
)
def test_without_two_seats_the_rotor_does_not_lie(stations: str, tmp_path: Path) -> None:
    path = tmp_path / "plain.toml"
    head, _, tail = stations.rpartition("[stations]")
    path.write_text(head + PLAIN + (f"[stations]{tail}" if tail else ""), encoding="utf-8")
    found = report(str(path), tmp_path)
    assert TO_REST in found.text
    assert [p.name for p in found.pictures] == ["campbell.png", "modes.png"]
    assert not (tmp_path / "rest.png").exists()
    if not stations:  # all modes may be asked for
        whole = shaft_file(tmp_path, "[stations]\nA = 1\nB = 9\nsame = 9\n")
        found = report(str(whole), tmp_path, speed=0.0, modes=0)
        assert "bending 16" in found.text
        assert "B = same" in found.text
        assert [p.stem for p in found.pictures] == ["campbell", "modes", "critical", "rest"]


def test_critical_speeds_are_told_and_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    springs = ["--support", "amb_A=20 MN/m", "--support", "amb_B=25 MN/m"]
    assert main(["rotor", "rotor_II", *springs, "--speed", "10000 rpm", "-o", str(tmp_path)]) == 0
    assert (tmp_path / "critical.png").is_file()
    told = capsys.readouterr().out
    assert "on its 2 supports at 10000 rpm" in told
    assert "held at amb_A, amb_B by" in told
    assert "held at A, B by" in told
    own = re.search(r"its own supports +(\d+) +(\d+)", told)
    assert own
    expected = touchdown.Rotor.load("rotor_II").critical_speeds({"amb_A": 20e6, "amb_B": 25e6})
    assert [float(speed) for speed in own.groups()] == pytest.approx(30.0 / math.pi * expected[:2], abs=0.5)
    with pytest.raises(TouchdownError, match="critical speeds need supports at two nodes of Rotor II"):
        touchdown.Rotor.load("rotor_II").critical_speeds({"amb_A": 2e7})


@pytest.mark.parametrize(
    ("rotor", "diameter", "width"), [("rotor_I", 56.7, 20.8), ("rotor_II", 177.7, 13.7)]
)
def test_a_disc_is_drawn_as_large_as_its_file_has_it(rotor: str, diameter: float, width: float) -> None:
    """From its inertias: the shaft keeps no diameters of discs. A mass without inertias is a mark."""
    shaft = rotor_named(rotor)
    point = max(shaft.points, key=lambda one: one.polar_inertia)
    (axes,) = drawing(sheet(), shaft)
    bodies = [patch for patch in axes.patches if patch.get_facecolor() == to_rgba(DISC)]
    disc = max((body.get_path().get_extents() for body in bodies), key=lambda box: box.height)
    assert (disc.height, disc.width) == pytest.approx((diameter, width), abs=0.05)
    assert disc.x0 + 0.5 * disc.width == pytest.approx(1e3 * shaft.positions()[point.node - 1])
    (axes,) = drawing(sheet(), replace(shaft, points=(PointMass(5, 1.0),)))
    assert any(line.get_marker() == "D" for line in axes.lines)
