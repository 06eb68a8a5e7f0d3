"""Rotor files: a shaft written by hand in TOML, read with every mistake named, and written again.

    title = "Stub shaft"

    [material.steel]
    modulus = "207 GPa"
    density = "7830 kg/m3"
    poisson = 0.3            # a material without it can be a sleeve only

    [material.laminations]
    modulus = "0 GPa"        # carries nothing
    density = "7650 kg/m3"

    [[element]]              # in order from node 1
    length = "20 mm"         # of each of them
    count = 4
    outer_diameter = "28 mm"
    sleeve = { outer_diameter = "55 mm", material = "laminations" }

    [[disc]]
    node = 5
    outer_diameter = "80 mm"
    inner_diameter = "28 mm"
    width = "10 mm"

    [[unbalance]]
    node = 5
    moment = "3 g.mm"

    [stations]               # where bearings hold it: NAME = node
    A = 1
    B = 5
    amb = 3

    [sensors]                # where only its motion is asked for
    near_amb = 4

Also known: about, damping_ratio, levitated_at = ["amb"] (the stations that hold the rotor at rest at the
start); in an element inner_diameter, material, position (its start, to check the sum of lengths),
shear_factor (Cowper's where it is not given), outer_diameter_end and inner_diameter_end, which make it a
cone (over all of its count), and layers, cylinders or cones around it that are held to it at the nodes:

    layers = [{ outer_diameter = "50 mm", outer_diameter_end = "60 mm", material = "bronze" }]

[[point_mass]] with node, mass, polar_inertia, diametral_inertia; in an unbalance angle; [[support]] with
node, stiffness, stiffness_y, damping, damping_y, for frequencies on supports (a scene has bearings);
[[gap]] with name, station (or sensor), node or position, radial and, where touching acts, journal_radius.
Every physical quantity is text with a unit.

In place of materials, elements, discs and point masses a rotor may have [superelement], the matrices of the
whole in one plane (`rotor.file.superelement`), which `touchdown import rotor` writes.
"""

from .reader import RotorFileError, parse
from .storage import find, load, save, shipped, text_of
from .writer import written

__all__ = ["RotorFileError", "find", "load", "parse", "save", "shipped", "text_of", "written"]
