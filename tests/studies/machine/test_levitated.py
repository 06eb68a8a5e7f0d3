"""A new machine with magnets and a controller: sizes by closed forms, zone A, what the rotor then does."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED
from touchdown.studies.loop.design import Section
from touchdown.studies.loop.linear_loops import Sampled, shortfalls
from touchdown.studies.loop.over_speed import settled
from touchdown.studies.machine import levitated
from touchdown.studies.machine.machine_design import CURRENT, FLUX, Magnets

MACHINES = {  # what is asked for; the levitated rotors of the shipped scenes, and one that is rigid
    "disk": {"bearings": "6004", "mass": "1.65 kg", "speed": "9000 rpm"},
    "rotor_I": {"bearings": "6004", "rotor": "rotor_I", "speed": "9000 rpm"},
    "rotor_II": {"bearings": "7014", "rotor": "rotor_II"},
    "compressor": {
        "bearings": "61909",
        "rotor": "compressor_rotor",
        "speed": "32000 rpm",
        "clearance": "0.12 mm",
    },
}
SLOW = {"rotor_II", "compressor"}


@pytest.mark.parametrize("gap", [0.2e-3, 0.5e-3])
def test_magnets_by_the_force_law(gap: float) -> None:
    """At the current limit; the model's own magnets are asked below."""
    one = Magnets(100.0, gap, 1000.0, 6.0)
    mu0 = 4e-7 * math.pi
    density = mu0 * one.turns * CURRENT / (2.0 * gap)  # T, both gaps in series
    assert FLUX * (1.0 - 1.0 / one.turns) < density <= FLUX  # turns are a whole number
    force = density**2 * one.area / mu0 * math.cos(math.pi / 8)  # N, of two poles
    assert 600.0 <= force * (FLUX / density) ** 2 < 1.12 * 600.0  # rounded up to two digits
    inductance = mu0 * one.turns**2 * one.area / (2.0 * gap)  # V s/A
    swing = one.swung * inductance * 0.5 * CURRENT  # V, of the bias at that frequency
    assert swing < one.voltage < 1.12 * swing * (FLUX / density) + 1.1 * 0.5 * CURRENT


@pytest.mark.parametrize("middle", [1.0, 0.8, 1.3])
def test_a_section_is_that_of_continuous_time_between_its_zeros_and_poles(middle: float) -> None:
    period, pole = 1e-4, 5000.0
    one = Section(pole * middle**2, 0.2, pole, 0.6)
    c = one.coefficients(period)
    w = pole * middle
    z, s = np.exp(1j * w * period), 1j * w

    def by(x: complex, frequency: float, ratio: float) -> complex:
        return x * x + 2.0 * ratio * frequency * x + frequency**2

    exact = by(s, one.zero, 0.2) / by(s, one.pole, 0.6) * (one.pole / one.zero) ** 2
    sampled = (c["b0"] + c["b1"] / z + c["b2"] / z**2) / (1.0 + c["a1"] / z + c["a2"] / z**2)
    assert sampled == pytest.approx(exact, rel=1e-9)
    assert (c["b0"] + c["b1"] + c["b2"]) / (1.0 + c["a1"] + c["a2"]) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in MACHINES]
)
def test_a_machine_in_zone_a_is_levitated_as_its_loops_have_it(name: str, tmp_path: Path) -> None:
    """And its orbits are those of the linear loops, to 3 %: of what turns with the rotor, in 20 ms."""
    scene = touchdown.new(tmp_path / "mine", **MACHINES[name], controller=True)
    found = touchdown.amb_margins(scene)
    assert not found.faults
    ups = [one for one in found.speeds if abs(one.speed) <= abs(found.own.speed)]
    assert min(abs(one.speed) for one in ups) == 0.0
    assert {margin.zone for one in ups for margin in one.margins} == {"A"}
    loops = found.loops
    assert isinstance(loops, Sampled)
    assert loops.bearings[0].axes[0].strongest > 0.95 * 6.0 * max(b.load for b in loops.bearings)
    assert not list(shortfalls(loops.bearings, settled(loops, found.own.speed, found.own.poles)))
    assert f"max |S| {max(one.peak for one in found.own.margins):.3g} (zone A)" in scene.about
    names = [b.controller for b in loops.bearings]
    still = {f"{one}.event[{k}].kind": "none" for one in names for k in (1, 2)}
    scene = scene.set({**still, "run.duration": "60 ms"})
    result = touchdown.run(scene, in_process=True)
    table = result.to_pandas()
    late = table[table.index > 0.02]
    turned = np.exp(-1j * found.own.speed * late.index.to_numpy())
    ports = [
        name.removesuffix(".x") for name in late if name.startswith("rotor.amb") and name.endswith(".x")
    ]
    assert len(ports) == len(names)
    clearance = found.clearance
    for k, port in enumerate(ports):
        x, y = late[f"{port}.x"], late[f"{port}.y"]
        assert np.hypot(x, y).max() < 0.1 * clearance
        if found.unbalance is not None:
            orbit = found.unbalance.at(found.own.speed, found.unbalance.orbits)[2 * k + 1]
            assert abs(np.mean(turned * (x - x.mean() + 1j * (y - y.mean())))) == pytest.approx(
                orbit, rel=0.03
            )


def test_the_written_machine_drops_and_is_levitated_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "mine", "--mass", "1.65 kg", "--bearings", "6004", "--controller"]) == 0
    assert "zone A" in capsys.readouterr().out
    summary = touchdown.run(touchdown.load("mine"), in_process=True).summary
    assert summary["seats"]["A"]["peak_contact_force"] > 10.0
    assert summary["seats"]["A"]["capture"] == "captured"


def test_why_a_loop_is_not_in_zone_a_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A controller that is asked too seldom; the files are there, the exit status says it, too."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(levitated, "PERIODS", (3e-3,))
    assert main(["new", "mine", "--mass", "1.65 kg", "--bearings", "6004", "--controller"]) == FAILED
    said = capsys.readouterr().out
    assert f"note: {levitated.UNFIT}\n" in said
    found = touchdown.amb_margins("mine")
    assert ("unknown current (nothing settles) for the unbalance" in said) == (not found.own.margins)
    assert "note: --controller: amb.axis[1] is in zone" in said or "note: --controller: unstable at" in said
    assert "sample_time" in said


def test_an_inclined_shaft_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    pair = ("--mass", "60 kg", "--bearings", "7014 AC DB", "--inclination", "90 deg")
    asked = ["new", "mine", *pair, "--controller"]
    assert main(asked) == FAILED
    assert "along its inclined shaft" in capsys.readouterr().err
