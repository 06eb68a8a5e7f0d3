"""A short shaft on two bushings, as files: the rotor with a gap of its own, and the machine."""

from __future__ import annotations

STUB = """
title = "Stub shaft"
[material.steel]
modulus = "207 GPa"
density = "7830 kg/m3"
poisson = 0.3
[[element]]
count = 4
length = "20 mm"
outer_diameter = "28 mm"
[stations]
A = 1
B = 5
[sensors]
near_amb = 3
[[gap]]
name = "magnet"
station = "near_amb"
radial = "0.35 mm"
"""
MACHINE = """
attach = [["bearing_A.journal", "rotor.A"], ["bearing_B.journal", "rotor.B"]]
[components.rotor]
fmu = "stub.toml"
[components.bearing_A]
fmu = "bushing"
[components.bearing_B]
fmu = "bushing"
"""
