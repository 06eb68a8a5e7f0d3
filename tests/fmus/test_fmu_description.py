"""modelDescription.xml of every FMU: valid, complete, true, and the same however it is built."""

from __future__ import annotations

import math
import os
import random
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pytest
from slave_driver import Slave

from touchdown.fmus.build import build_fmu
from touchdown.fmus.description.described_variables import base_unit, causality
from touchdown.fmus.description.fmi2 import describe_fmi2
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model, ModelError, Slot, slots
from touchdown.rotor.file import shipped_rotors

every_fmu = pytest.mark.parametrize("fmu", fmu_names())

DRAWS = 12  # starting points from which every parameter and input is moved
TRIES = 20  # to draw one that is not refused
SIZES = {"m": 1e-5, "rad": 1.0, "1": 0.1, "N": 100.0}  # of what is zero by default
COUNTS = (0, *range(2, 23))  # of modes, so that each place at a seat is taken by one, or free
THRUSTS = [  # whose table begins between two other points each time
    {"axial": 1, "thrust_points": 12, **{f"thrust[{k}].time": k - i - 0.5 for k in range(1, 13)}}
    for i in range(13)
]
ROTORS = [
    {"modes": count, "damping_ratio": 0.01, "unbalance_scale": 1e3} | THRUSTS[i % len(THRUSTS)]
    for i, count in enumerate(COUNTS)
]

MOUNTS = [  # whose carrier leans on its stop, with slides that stick or slide at once
    {
        "axial.stiffness": 1e6 * (i // 2 % 2), "inclination": 0.3 * (i % 3),
        "gravity": 9.81 * (1 + i), "spring.xx": 2e7, "spring.xy": 3e6 * (-1) ** i, "spring.yx": 4e6,
        "spring.yy": 1e7, "stop.gap": 1e-7 * (i % 3), "stop.stiffness": 1e10,
        "film.viscosity": 0.01 * (i % 2),
        **{f"slide[{k}].stiffness": 1e6 for k in range(1, 5)},
        **{f"slide[{k}].force": 5.0 * (i % 2) for k in range(1, 5)},
    }
    for i in range(12)
]  # fmt: skip
PLANE = {
    "balls.contact_angle": 0.0,
    "arrangement": 0,
    "preload": 0.0,
    "interference": 0.0,
    "balls.rows": 1,
    "shoulder.gap_minus": 0.0,
    "shoulder.gap_plus": 0.0,
}
PAIR = PLANE | {
    "balls.contact_angle": 0.3,
    "balls.rows": 2,
    "balls.play": 0.0,
    "row_distance": 0.01,
    "ring.harmonics": 0,
}
CLAMPED = [  # back to back and face to face by a force, in tandem, and back to back by an interference
    {"arrangement": 1, "preload": 50.0},
    {"arrangement": 2, "preload": 50.0},
    {"arrangement": 3},
    {"arrangement": 1, "interference": 5e-6},
]
PAIRS = [PAIR | CLAMPED[i // 2 % 4] if i % 2 else PLANE for i in range(16)]
SINGLE = {"arrangement": 0, "balls.rows": 1}
BODIES = ("angular_caged", "angular_cageless")
FIXED = {
    "mount": MOUNTS,
    "amb": [{"axial.stiffness": 1e6 * (i % 2)} for i in range(4)],
    "rigid_rotor": [table | {"transverse_inertia": i % 2} for i, table in enumerate(THRUSTS)],
    "simplified_caged": [{"slip": i % 2} for i in range(4)],
    "angular_simplified": PAIRS,
    **{name: [PAIR | clamped for clamped in (*CLAMPED, SINGLE)] for name in BODIES},
}
# shared with other bearings, and refused but for 0
NEVER = {name: {"ring.harmonics"} for name in BODIES}
# moves what hangs on it only together with balls.rows
JOINTLY = {name: {"arrangement"} for name in BODIES}
JOINED = {"foundation"}  # all that is in it hangs together, by rounding at least


@pytest.fixture
def xml(fmu: str, unpacked: Mapping[str, Path]) -> Element:
    """The model description of `fmu`."""
    return fromstring((unpacked[fmu] / "modelDescription.xml").read_bytes())


def scalars(xml: Element) -> list[tuple[dict[str, str], Element]]:
    """Attributes of every variable, and the element of its type."""
    return [(v.attrib, v[0]) for v in xml.iterfind("ModelVariables/ScalarVariable")]


def unknowns(xml: Element, kind: str) -> dict[str, list[str] | None]:
    """Names in ModelStructure/`kind`, with the names each depends on; None where that is left open."""
    order = [attributes["name"] for attributes, _ in scalars(xml)]
    found: dict[str, list[str] | None] = {}
    for element in xml.iterfind(f"ModelStructure/{kind}/Unknown"):
        known = element.get("dependencies")
        listed = None if known is None else [order[int(i) - 1] for i in known.split()]
        found[order[int(element.attrib["index"]) - 1]] = listed
    return found


# -- validity; the validators of fmpy and fmutool: .ci/run ------------------------------------------------


@every_fmu
def test_units_are_defined(fmu: str, xml: Element):
    """Those of all reals, with what they are shown in, by the base units of SI."""
    units = xml.findall("UnitDefinitions/Unit")
    shown = {
        (unit.attrib["name"], one.attrib["name"]) for unit in units for one in unit.iterfind("DisplayUnit")
    }
    reals = [kind for _, kind in scalars(xml) if kind.tag == "Real"]
    assert {kind.get("unit") for kind in reals} == {unit.attrib["name"] for unit in units}
    assert {
        (kind.get("unit"), kind.get("displayUnit")) for kind in reals if kind.get("displayUnit")
    } <= shown
    for unit in units:
        base = unit.find("BaseUnit")
        given = None if base is None else {k: int(v) for k, v in base.attrib.items()}
        assert given == base_unit(unit.attrib["name"]), unit.attrib["name"]


ROLES = {
    "parameter": {("fixed", "exact"), ("tunable", "exact")},
    "calculatedParameter": {("fixed", "calculated")},
    "input": {("continuous", None), ("discrete", None)},
    "output": {("continuous", "calculated"), ("discrete", "calculated")},
    "local": {("continuous", "calculated"), ("discrete", "calculated")},
}


@every_fmu
def test_variables(fmu: str, xml: Element, unpacked: Mapping[str, Path]):
    """Described, of a role that FMI knows; what is set starts within its bounds, as is told."""
    for attributes, kind in scalars(xml):
        name, role = attributes["name"], (attributes["variability"], attributes.get("initial"))
        assert attributes.get("description", "").strip(), name
        assert role in ROLES[attributes["causality"]], name
        assert (role[0] == "continuous") <= (kind.tag == "Real"), name
        assert ("start" in kind.attrib) == (attributes["causality"] in ("parameter", "input")), name
        start = float(kind.get("start", "0"))
        assert math.isfinite(start), name
        if "start" in kind.attrib:
            assert float(kind.get("min", "-inf")) <= start <= float(kind.get("max", "inf")), name
    slave = Slave(unpacked[fmu])
    told = {n: float(slave.variables[n].start) for n in slave.named("parameter", "input")}
    held = slave.get(told)
    slave.free()
    assert held == told


@every_fmu
def test_choices_are_enumerations(fmu: str, xml: Element):
    """Words for all whole numbers between the bounds, which are what FMI sets."""
    types = {t.attrib["name"]: t[0] for t in xml.iterfind("TypeDefinitions/SimpleType")}
    chosen = {a["name"]: kind for a, kind in scalars(xml) if kind.tag == "Enumeration"}
    assert {kind.attrib["declaredType"] for kind in chosen.values()} == set(types)
    for name, kind in chosen.items():
        items = {int(i.attrib["value"]): i.attrib["name"] for i in types[kind.attrib["declaredType"]]}
        assert list(items) == list(range(int(kind.attrib["max"]) + 1)), name
        assert int(kind.attrib["start"]) in items
        assert len(set(items.values())) == len(items)


def test_every_fmu_has_an_identity_of_its_own(unpacked: Mapping[str, Path]):
    descriptions = [
        fromstring((unpacked[fmu] / "modelDescription.xml").read_bytes()) for fmu in fmu_names()
    ]
    assert len({d.attrib["guid"] for d in descriptions}) == len(fmu_names())


# -- structure ---------------------------------------------------------------------------------------


def draw(slot: Slot, default: float, chance: random.Random) -> float:
    """A value near `default` but not it, within the variable's bounds."""
    spec = slot.variable.spec
    if spec.kind == "integer":
        low = default - 1 if spec.minimum is None else max(spec.minimum, default - 1)
        high = default + 1 if spec.maximum is None else min(spec.maximum, default + 1)
        return chance.choice([v for v in (low, high) if v != default])
    size = abs(default) or SIZES.get(spec.unit, 1.0)
    value = default + size * chance.uniform(0.02, 0.2)
    if slot.variable.name == "shutdown_time":  # only whether it is over matters at the start
        return chance.choice((value, 0.0))
    if slot.variable.name == "balls.outer_conformity":  # 0, or that of a groove wider than the ball
        return 1.0 + abs(value)
    return default - (value - default) if spec.maximum is not None and value > spec.maximum else value


def first_values(instance: Instance, values: Mapping[str, float]) -> dict[str, float] | None:
    """Outputs after initialisation with `values`; None where the model refuses them."""
    for slot in instance.slots:
        if slot.variable.name in values:
            value = values[slot.variable.name]
            instance.store(slot)[slot.index] = value if slot.variable.spec.kind == "real" else int(value)
    try:
        instance.start(0.0)
    except ModelError:
        return None
    return {s.variable.name: instance.store(s)[s.index] for s in instance.slots if s.causality == "output"}


def observed_dependencies(
    model: Model, fixed: Sequence[Mapping[str, float]] = ()
) -> tuple[dict[str, set[str]], set[str]]:
    """Which parameters and inputs move each output's first value; those that could not be moved.

    Of the modes at a seat the first stands for all. A static force that is stated takes the place of
    what follows from others: every third draw leaves it unstated. `fixed`: what is not drawn, in turns.
    """
    instance = Instance(model)
    every = [slot for slot in slots(model) if slot.causality != "output"]
    known = [slot for slot in every if not re.search(r"\.mode\[(?!1\])", slot.variable.name)]
    defaults = {slot.variable.name: slot.variable.default for slot in known}
    chance = random.Random(20)
    moved: dict[str, set[str]] = defaultdict(set)
    untried = set(defaults)
    for attempt in range(max(DRAWS, 1 + len(fixed))):
        base, before = dict(defaults), first_values(instance, defaults) if attempt == 0 else None
        kept = {"contact.law"} if attempt % 2 else set[str]()  # each law hides the other's constants
        off = [slot for slot in known if attempt % 3 or "static_" not in slot.variable.name]
        off = [slot for slot in off if slot.variable.name not in kept]
        tries = 0
        while before is None and tries < TRIES:
            base = defaults | {
                slot.variable.name: draw(slot, slot.variable.default, chance) for slot in off
            }
            base |= fixed[(attempt - 1) % len(fixed)] if fixed else {}
            before, tries = first_values(instance, base), tries + 1
        if before is None:
            continue
        for slot in known:
            name = slot.variable.name
            after = first_values(instance, {**base, name: draw(slot, base[name], chance)})
            if after is not None:
                untried.discard(name)
                for output, value in after.items():
                    if value != before[output]:
                        moved[output].add(name)
    return moved, untried


def declared_dependencies(xml: Element) -> dict[str, set[str]]:
    """InitialUnknowns of a description."""
    return {name: set(known or ()) for name, known in unknowns(xml, "InitialUnknowns").items()}


@every_fmu
def test_structure_lists_outputs_and_initial_unknowns(fmu: str, xml: Element):
    """With what each depends on."""
    outputs, initial = unknowns(xml, "Outputs"), unknowns(xml, "InitialUnknowns")
    assert list(outputs) == [a["name"] for a, _ in scalars(xml) if a["causality"] == "output"]
    roles = ("output", "calculatedParameter")
    assert set(initial) == {a["name"] for a, _ in scalars(xml) if a["causality"] in roles}
    assert None not in (*outputs.values(), *initial.values())


@pytest.mark.slow
@every_fmu
def test_initial_dependencies_are_those_observed(fmu: str, xml: Element):
    model = recipe(fmu).model
    exposed = {
        slot.variable.name
        for slot in slots(model)
        if causality(slot)[0] in ("output", "calculatedParameter")
    }
    moved, untried = observed_dependencies(model, ROTORS if fmu in shipped_rotors() else FIXED.get(fmu, ()))
    assert untried == NEVER.get(fmu, set())
    declared = declared_dependencies(xml)
    assert set(declared) == exposed
    assert all(moved[name] <= declared[name] for name in exposed)
    if fmu not in JOINED:
        jointly = JOINTLY.get(fmu, set())
        assert not [name for name in exposed if declared[name] - moved[name] - jointly]


# -- units -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("unit", "exponents"),
    [
        ("1", {}),
        ("m", {"m": 1}),
        ("N", {"kg": 1, "m": 1, "s": -2}),
        ("N.s/m2", {"kg": 1, "m": -1, "s": -1}),
        ("N.m.s/rad", {"kg": 1, "m": 2, "s": -1, "rad": -1}),
        ("1/(kg.m2)", {"kg": -1, "m": -2}),
        ("Pa", {"kg": 1, "m": -1, "s": -2}),
        ("W.s/J", {}),
        ("N/m^n", None),
    ],
)
def test_base_unit(unit: str, exponents: dict[str, int] | None):
    assert base_unit(unit) == exponents


# -- reproducibility ---------------------------------------------------------------------------------


AGAIN = ("housing", "rotor_I")


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """FMUs built in another process, from another working directory and with another hash seed."""
    script = """
import pathlib, sys
from touchdown.fmus.build import build_fmu
from touchdown.fmus.recipes import recipe
for name in sys.argv[1:]:
    build_fmu(recipe(name), pathlib.Path('.'))
"""
    folder, environment = tmp_path_factory.mktemp("elsewhere"), {**os.environ, "PYTHONHASHSEED": "4711"}
    subprocess.run([sys.executable, "-c", script, *AGAIN], cwd=folder, env=environment, check=True)
    return folder


@pytest.mark.parametrize("fmu", AGAIN)
def test_building_again_gives_equal_bytes(
    fmu: str, built: Mapping[str, Path], elsewhere: Path, tmp_path: Path
):
    here = build_fmu(recipe(fmu), tmp_path / "here").read_bytes()
    assert here == built[fmu].read_bytes()
    assert here == (elsewhere / f"{fmu}.fmu").read_bytes()
    assert [path.name for path in (tmp_path / "here").iterdir()] == [f"{fmu}.fmu"]


def test_values_are_shown_in_units_that_people_think_in():
    """By their size: a radius in mm, a play in um."""
    shown = {}
    for name in ("simplified_caged", "amb", "rotor_I"):
        root = describe_fmi2(recipe(name).model, name, {})
        shown |= {a["name"]: kind.get("displayUnit", kind.get("unit")) for a, kind in scalars(root)}
    expected = {
        "journal_radius": "mm", "balls.play": "um", "journal.x": "um", "balls.first_angle": "deg",
        "journal.omega": "rpm", "speed": "rpm", "bandwidth": "rad/s", "stiffness": "kN/m",
        "shutdown_time": "ms", "micro_step": "us", "balls.modulus": "GPa", "stress.bending": "MPa",
        "ring.mass": "g", "ring.inertia": "kg.mm2", "node[1].position": "mm", "contact.force": "N",
    }  # fmt: skip
    assert {name: shown[name] for name in expected} == expected


@pytest.mark.parametrize("unit", ["furlong", "N/ft", "N.lb"])
def test_base_unit_refuses_what_it_does_not_know(unit: str):
    with pytest.raises(ValueError, match="unknown unit"):
        base_unit(unit)
