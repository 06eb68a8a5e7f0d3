"""Rotors: beams, whirls in bearings, ROSS's published examples, the threshold of dry whip."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ..bearings.magnetic.magnet import Circuit, Magnet, lay_out_circuit
from ..modelkit.variables import as_record
from ..rotor.beams.beam_body import PointMass, disc_mass
from ..rotor.beams.element import Element, split_element
from ..rotor.beams.shaft import Shaft, Support, assembled_matrices
from ..rotor.imports import read_rotor
from ..rotor.modal.contact_whirl import ContactWhirl, WhirlSeat, rigid
from ..rotor.modal.modes import basis
from ..rotor.modal.supported import Foundation, HeldRotor, LinearBearing
from ..rotor.modal.whirl_speeds import critical_speeds, whirl_frequencies
from .case import Row

STEEL: dict[str, Any] = {"modulus": 207e9, "density": 7830.0, "poisson": 0.3}
LENGTH = 0.8
ONE = np.eye(2)


def _beam(count: int, length: float = LENGTH, **changes: float) -> Shaft:
    """A shaft of 60 mm in `count` elements."""
    settings: dict[str, Any] = {"length": length / count, "outer_diameter": 0.06, **STEEL, **changes}
    element = Element(**settings)
    return Shaft("beam", (element,) * count)


def free_beam() -> list[Row]:
    """First three frequencies of a free shaft of 60 mm by 8 m in 60 elements, stiff in shear."""
    shaft = _beam(60, 8.0, shear_factor=1e6)
    element = shaft.elements[0]
    found = basis(shaft, 5).omega[2:] / (2.0 * math.pi)
    unit = math.sqrt(element.EI / element.mass_per_length) / 64.0 / (2.0 * math.pi)
    rows = []
    for k, hz in enumerate(found, start=1):
        middle = (k + 0.5) * math.pi
        b: Any = brentq(lambda x: math.cos(x) - 1.0 / math.cosh(x), middle - 0.5, middle + 0.5)
        rows.append(Row(f"bending mode {k}", "Hz", float(b) ** 2 * unit, float(hz)))
    return rows


def clamped_cone() -> list[Row]:
    """Deflection of the thin end of a steel cone of 0.5 m, 100 to 40 mm, under 1 kN there."""
    cone = Element(
        length=0.5, outer_diameter=0.1, outer_diameter_end=0.04, modulus=211e9, density=7810.0, poisson=0.3
    )
    wide, ratio = cone.section(0.0), 0.4
    exact = cone.length**3 / (3.0 * wide.EI * ratio) + cone.length / (wide.kGA * ratio)
    stiffness = assembled_matrices(Shaft("cone", tuple(split_element(cone, 64)))).stiffness[2:, 2:]
    force = np.zeros(len(stiffness))
    force[-2] = 1.0
    found = float(np.linalg.solve(stiffness, force)[-2])
    return [Row("deflection under 1 kN", "um", 1e9 * exact, 1e9 * found)]


def spinning_top() -> list[Row]:
    """Tilting whirls at 2000 rad/s, Ip/Id W/2 -+ sqrt(w0^2 + (Ip W/2 Id)^2), and the bounce."""
    shaft = Shaft("top", _beam(2, modulus=2e14).elements, (disc_mass(2, 0.4, 0.06, 0.02, 7830.0),))
    k, speed = 1e6, 2000.0
    tilt = math.sqrt(2.0 * k * (LENGTH / 2.0) ** 2 / shaft.diametral_inertia)
    half = 0.5 * shaft.polar_inertia / shaft.diametral_inertia * speed
    bounce = math.sqrt(2.0 * k / shaft.mass)
    expected = sorted([half - math.hypot(tilt, half), half + math.hypot(tilt, half), bounce, -bounce])
    found = sorted(whirl_frequencies(basis(shaft, 2), [speed], [(1, k), (3, k)])[0])
    names = {expected.index(bounce): "bounce, forward", expected.index(-bounce): "bounce, backward"}
    tilts = iter(("tilt, backward", "tilt, forward"))
    return [
        Row(names.get(n) or next(tilts), "rad/s", theirs, float(ours))
        for n, (theirs, ours) in enumerate(zip(expected, found, strict=True))
    ]


def jeffcott() -> list[Row]:
    """A disc of 20 kg amid a light shaft of 0.6 m by 50 mm on springs of 1 N/um."""
    element = Element(length=0.15, outer_diameter=0.05, modulus=2e11, density=7.83, poisson=0.3)
    rotor = Shaft("Jeffcott", (element,) * 4, points=(PointMass(3, 20.0),))
    held = [LinearBearing(node, 1e6 * ONE, 0.0 * ONE) for node in (1, 5)]
    found = HeldRotor(basis(rotor, 0), held).damped_modes(900.0).roots[0].imag
    give = 0.6**3 / (48.0 * element.EI) + 0.6 / (4.0 * element.kGA) + 0.5e-6
    return [Row("frequency", "rad/s", math.sqrt(1.0 / (20.0 * give)), float(found))]


ROSS = Path(__file__).parent / "ross"


def ross_modes(name: str) -> list[Row]:
    """Imported from what ROSS saved: twelve lowest whirls, backward and forward, at three speeds, free and
    on undamped bearings, and four critical speeds over the bearings' stiffness. A row is the frequency that
    is farthest off."""
    theirs: dict[str, dict[str, list[float]]] = _stored()["hz"][name]
    shaft = read_rotor(ROSS / f"{name}.toml")
    modes = basis(shaft, 0)
    springs = [LinearBearing.of(Support(s.node, s.stiffness, s.stiffness_y)) for s in shaft.supports]
    rows = []
    for rpm, hz in theirs["free"].items():
        found = np.abs(whirl_frequencies(modes, [_turning(rpm)])[0]) / (2.0 * math.pi)
        bent = found[found > 0.5 * basis(shaft, 3).omega[2] / (2.0 * math.pi)]
        rows.append(_farthest(f"free, {rpm} rpm", "Hz", hz, np.sort(bent)))
    for rpm, hz in theirs["held"].items():
        found = HeldRotor(modes, springs).damped_modes(_turning(rpm)).frequencies
        rows.append(_farthest(f"on its bearings, {rpm} rpm", "Hz", hz, np.sort(found)))
    for stiffness, speeds in theirs["critical"].items():
        supports = [Support(s.node, float(stiffness)) for s in shaft.stations]
        found = critical_speeds(modes, supports)
        critical = f"critical speeds at {float(stiffness):.0e} N/m"
        rows.append(replace(_farthest(critical, "rad/s", speeds, found), tolerance=1e-7))
    return rows


def _roots_apart(
    what: str, theirs: Sequence[Sequence[float]], ours: np.ndarray, tolerance: float | None = None
) -> list[Row]:
    """Damped frequency and decay of the roots (1/s), of each the one farthest off, nearest to nearest."""
    pairs = [(complex(*one), ours[np.argmin(np.abs(ours - complex(*one)))]) for one in theirs]
    rows = []
    for kind, unit, scale, part in (
        ("frequency", "Hz", 2.0 * math.pi, np.imag),
        ("decay", "1/s", -1.0, np.real),
    ):
        expected, found = ([float(part(pair[k])) / scale for pair in pairs] for k in (0, 1))
        rows.append(
            replace(_farthest(f"{what}, {kind}", unit, expected, np.array(found)), tolerance=tolerance)
        )
    return rows


def _stored() -> dict[str, Any]:
    """ROSS's figures."""
    return json.loads((ROSS / "frequencies.json").read_text(encoding="utf-8"))


def _turning(rpm: str) -> float:
    """In rad/s."""
    return float(rpm) * math.pi / 30.0


def _farthest(what: str, unit: str, theirs: Sequence[float], ours: np.ndarray) -> Row:
    """The worst of some ascending frequencies as a row."""
    rows = [Row(what, unit, a, float(b)) for a, b in zip(theirs, ours[: len(theirs)], strict=True)]
    worst = max(rows, key=lambda row: abs(row.deviation or 0.0))
    return replace(worst, quantity=f"{what}, the worst of {len(rows)}")


INTERPOLATED = 2e-3  # of roots, where ROSS interpolates its controller's answer


def ross_supports() -> list[Row]:
    """Damped roots, six backward and six forward, at three speeds: bearings of 10 and 8 N/um with 1000 and
    800 N s/m, under each 20 kg on 50 N/um and 2000 N s/m."""
    published = _stored()["supports"]
    bearing, support = published["bearing"], published["support"]
    shaft = read_rotor(ROSS / "rotor_example.toml")
    under = Foundation(support["mass"], support["kxx"], support["cxx"])
    stiffness, damping = (np.diag([bearing[f"{k}xx"], bearing[f"{k}yy"]]) for k in "kc")
    held = [LinearBearing(s.node, stiffness, damping, foundation=under) for s in shaft.supports]
    rotor, rows = HeldRotor(basis(shaft, 0), held), []
    for rpm, roots in published["roots"].items():
        rows += _roots_apart(f"{rpm} rpm", roots, rotor.damped_modes(_turning(rpm)).roots)
    return rows


def ross_magnetic() -> list[Row]:
    """Force per current and displacement of its magnets from gap, pole, turns and bias; free bending;
    damped roots while levitated by P = 1000 A/m and D = 5 A s/m at two speeds. In ROSS the gap at an
    inclined pole closes by the whole displacement: its force per displacement is ours over the cosine of
    the pole's angle."""
    published = _stored()["magnetic"]
    b = published["bearing"]
    circuit: Any = as_record(Circuit())
    magnet = Magnet(gap=b["g0"], area=b["ag"], turns=b["nw"], pole_angle=b["alpha"])
    lay_out_circuit(circuit, as_record(magnet), b["i0"], math.cos(magnet.pole_angle))
    k_i, k_s = (
        float(circuit["current_factor"]),
        float(circuit["displacement_factor"]) / math.cos(b["alpha"]),
    )
    shaft = read_rotor(ROSS / "rotor_amb_example.toml")
    rows = [
        Row("force per current", "N/A", published["k_i"], k_i),
        Row("force per displacement", "N/m", published["k_s"], k_s),
    ]
    for rpm, hz in published["free"].items():
        found = np.abs(whirl_frequencies(basis(shaft, 0), [_turning(rpm)])[0]) / (2.0 * math.pi)
        bent = np.sort(found[found > 0.5 * basis(shaft, 3).omega[2] / (2.0 * math.pi)])
        rows.append(_farthest(f"free, {rpm} rpm", "Hz", hz, bent))
    for rpm, roots in published["roots"].items():
        w = _turning(rpm)
        answer = k_s + k_i * (b["kp_pid"] + 1j * w * b["kd_pid"] / (1.0 + 1j * w / b["n_f"]))
        held = [LinearBearing(n + 1, answer.real * ONE, answer.imag / w * ONE) for n in published["nodes"]]
        found = HeldRotor(basis(shaft, 0), held).damped_modes(w).roots
        rows += _roots_apart(f"levitated, {rpm} rpm", roots, found, INTERPOLATED)
    return rows


def dry_whip() -> list[Row]:
    """Least ratio of friction to normal force that keeps a backward whirl up, zeta = 0.05."""
    mass, k, zeta = 1.0, 1e6, 0.05
    damping = 2.0 * zeta * math.sqrt(k * mass)

    def rotor(omega: float) -> np.ndarray:
        return np.array([[1.0 / (k - mass * omega**2 + 1j * omega * damping)]])

    rows = []
    for beta in (1.0, 10.0, 40.0):

        def stator(depth: float, omega: float, beta: float = beta) -> complex:
            return complex(-beta * k * depth, math.copysign(beta * k * depth, omega))

        whirl = ContactWhirl(rotor, [WhirlSeat(0.2e-3, stator, rigid)])
        circles = list(whirl.faster(-100.0, -2.0 * math.sqrt((1.0 + beta) * k / mass)))
        exact = 2.0 * zeta * math.sqrt(1.0 + beta) / beta
        rows.append(Row(f"friction, beta = {beta:g}", "", exact, min(c.drive for c in circles)))
    return rows
