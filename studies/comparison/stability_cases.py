"""The cases of a comparison of stability: what is hard on a coupling scheme, most of it short.

Drops start just above the bearing, at the speed of the fall, so that little time goes by in flight. All
runs end at a whole number of milliseconds, which every macro step divides.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ...master.common.errors import TouchdownError, one_of
from ...master.scene.file import load_scene
from ...master.scene.run_spec import RunSpec
from ...master.scene.scene import ComponentSpec, Scene

STEPS = (*(float(f"{digit}e{power}") for power in (-6, -5, -4) for digit in (1, 2, 5)), 1e-3)  # s
FIRST_STEP = 2e-5  # s, where the search begins


@dataclass(frozen=True)
class _Figure:
    """A number read at the end of a run: a variable, or the sum of several."""

    title: str
    variables: tuple[str, ...]  # COMPONENT.VARIABLE
    scale: float | None = None  # what an error is related to; None: the right value


@dataclass(frozen=True)
class Expected:
    """The expected result of a run."""

    values: tuple[float, ...]  # of the case's figures
    speed: float  # m/s, of the fastest journal at its fastest
    distance: float  # m, of a journal from the origin at its farthest
    rate: float = 0.0  # rad/s, of a journal's swing on its fastest contact


@dataclass(frozen=True)
class Case:
    """A scene that is hard on coupling schemes, and how its runs are judged."""

    name: str
    title: str
    scene: Scene  # to an end that all of `steps` divide
    figures: tuple[_Figure, ...]
    journals: tuple[str, ...] = ("rotor.A",)  # ports of bodies
    theory: Expected | None = None  # None: a run at REFERENCE_STEP says what is right
    steps: tuple[float, ...] = STEPS
    first: float = FIRST_STEP  # one of them
    long: bool = False  # takes minutes


GRAVITY = 9.81  # m/s2
CLEARANCE = 0.3e-3  # m, of the disk
DISK = {"mass": 1.65, "inertia": 0.5e-3}  # kg, kg.m2
RING_MASS = 0.015  # kg, inner ring of its bearing
START_HEIGHT = -0.29e-3  # m, height at which the disk's drops start
START_SPEED = -math.sqrt(-2.0 * GRAVITY * START_HEIGHT)  # m/s, when it passes there
FINE_MICRO_STEP = 5e-7  # s, micro step of bearings that have one

FRICTIONLESS = {"friction.static": 0.0, "friction.dynamic": 0.0, "friction.g6": 0.0}

REBOUND = _Figure("rebound speed", ("rotor.A.vy",))
PEAK = _Figure("peak force", ("bearing.contact.peak_force",))


def _disk(rotor: Mapping[str, object], settings: Mapping[str, object], ms: int) -> Scene:
    """A rigid rotor in a bushing that stands in the ground."""
    return Scene(
        "disk",
        "disk",
        {
            "rotor": ComponentSpec("rigid_rotor", {**DISK, **rotor}),
            "bearing": ComponentSpec("bushing", dict(settings)),
        },
        attach=(("bearing.journal", "rotor.A"),),
        energy_scale=("rotor.mass", "rotor.gravity", "bearing.clearance"),
        run=RunSpec(duration=1e-3 * ms),
    )


def _without_magnetic_bearings(name: str) -> Scene:
    """A scene of the project's without its magnetic bearings."""
    scene = load_scene(name)
    magnetic = {key for key, spec in scene.components.items() if spec.fmu == "amb"}
    remaining = {key: spec for key, spec in scene.components.items() if key not in magnetic}
    attach = tuple(pair for pair in scene.attach if pair[0].partition(".")[0] not in magnetic)
    return replace(scene, components=remaining, attach=attach, sense=(), zero=None)


def _dropped(settings: Mapping[str, object], ms: int) -> Scene:
    """The disk from just above its caged bearing."""
    start = {"rotor.y": START_HEIGHT, "rotor.vy": START_SPEED, "run.duration": 1e-3 * ms}
    return _without_magnetic_bearings("disk-caged-simplified").set({**start, **settings})


def bounce() -> Case:
    """Neither spring nor scheme may make or lose energy: half a period of mass and spring, then off."""
    speed, mass, stiffness = 0.1, 10.0, 1e8
    rotor = {"mass": mass, "gravity": 0.0, "y": -CLEARANCE + 7e-7, "vy": -speed, "speed": 0.0}
    spring = {
        "contact.stiffness": stiffness,
        "contact.exponent": 1.0,
        "contact.damping": 0.0,
        **FRICTIONLESS,
    }
    scene = replace(_disk(rotor, spring, 2), energy_scale=("rotor.mass", "rotor.vy", "rotor.vy"))
    indentation = speed * math.sqrt(mass / stiffness)
    return Case(
        "bounce",
        "undamped elastic bounce",
        scene,
        (REBOUND, PEAK),
        theory=Expected((speed, stiffness * indentation), speed, CLEARANCE + indentation),
    )


def _stiffness(times: int) -> Case:
    """The disk on its caged bearing, the contact of journal and ring stiffer."""
    scene = _dropped({"bearing.contact.stiffness": times * 2.4e9}, 3)
    about = "disk" if times == 1 else f"disk, its contact {times} times as stiff"
    return Case(f"stiffness-{times}", about, scene, (REBOUND, PEAK))


def _mass(times: int) -> Case:
    """A journal as light as the ring it lands on, or some times heavier."""
    settings = {f"rotor.{name}": times * RING_MASS / DISK["mass"] * value for name, value in DISK.items()}
    scene = _dropped(settings, 2)
    speed = _Figure("speed", ("rotor.A.vy",), -START_SPEED)
    factor = "" if times == 1 else f"{times} times "
    return Case(f"mass-{times}", f"journal {factor}as heavy as the ring", scene, (speed, PEAK))


def _rotor(name: str, settings: Mapping[str, object]) -> Scene:
    """A scene of rotor I, let go; micro steps are fine, so that errors are the coupling's alone."""
    fine = {f"bearing_{end}.micro_step": FINE_MICRO_STEP for end in "AB"}
    return _without_magnetic_bearings(name).set({**fine, **settings})


def _on_two(name: str, title: str, scene: Scene, scale: float) -> Case:
    """Peaks and final speeds at both seats; scale (m/s): what errors of speeds are related to."""
    peaks = [_Figure(f"peak force {end}", (f"bearing_{end}.contact.peak_force",)) for end in "AB"]
    speeds = [
        _Figure(f"speed {end} {axis}", (f"rotor.{end}.v{axis}",), scale) for end in "AB" for axis in "xy"
    ]
    return Case(name, title, scene, (*peaks, *speeds), ("rotor.A", "rotor.B"))


def _whirl() -> Case:
    """Rotor I thrown along the wall into backward whirl: a turn at 5 kN, the rings dragged up."""
    start = {"rotor.y": -0.19e-3, "rotor.vx": -0.6, "run.duration": 3e-3}
    scene = _rotor("rotor1-18000-225um", start)
    return _on_two("whirl", "rotor I at 18000 rpm, bearings at -225 and 225 um, backward whirl", scene, 0.6)


def _modes(count: int) -> Case:
    """Rotor I to 9 ms after its shutdown: first impact at both ends with elastic modes."""
    scene = _rotor("rotor1-9000", {"rotor.modes": count, "run.duration": 9e-3})
    return _on_two(f"modes-{count}", f"rotor I dropped, {count} modes", scene, -START_SPEED)


def _together() -> Case:
    """Rotor I neither turning nor out of balance: both bearings are hit in the same instant."""
    still = {"rotor.speed": 0.0, "rotor.unbalance_scale": 0.0, "run.duration": 9e-3}
    return _on_two("together", "two bearings hit at once", _rotor("rotor1-9000", still), -START_SPEED)


def _grazing() -> Case:
    """The disk falls past the side of a bushing and only just touches it, at about 1 mm/s."""
    side = 0.29e-3
    y = -math.sqrt(CLEARANCE**2 - side**2)
    rotor = {"x": side, "y": y + 1e-6, "vy": -math.sqrt(2.0 * GRAVITY * 1e-6)}
    scene = _disk(rotor, {}, 2)
    speeds = tuple(_Figure(f"speed {axis}", (f"rotor.A.v{axis}",), 0.02) for axis in "xy")
    return Case("grazing", "grazing contact", scene, (*speeds, PEAK))


def _hold() -> Case:
    """Rotor I with 20 modes on its magnetic bearings, which bring it back from 20 um beside."""
    kept = {f"amb_{end}.shutdown_time": 1.0 for end in "AB"}
    scene = load_scene("rotor1-9000").set(
        {**kept, "rotor.modes": 20, "rotor.x": 20e-6, "run.duration": 10e-3}
    )
    places = tuple(
        _Figure(f"{axis} at {end}", (f"rotor.{end}.{axis}",), 20e-6) for end in "AB" for axis in "xy"
    )
    return Case("hold", "held with 20 modes", replace(scene, zero=None), places, ("rotor.A", "rotor.B"))


def _stick() -> Case:
    """A slow disk drags the ring up to its speed within the impact, friction ten times steeper."""
    steep = {"friction.slope": 1000.0, "friction.g2": 1000.0, "friction.g3": 100.0}
    settings = {f"bearing.{name}": value for name, value in steep.items()} | {"rotor.speed": 100.0}
    ring = _Figure("ring's speed", ("bearing.ring.omega",), 100.0)
    scene = _dropped(settings, 3)
    return Case("stick", "stick-slip, friction ten times steeper", scene, (ring, REBOUND, PEAK))


def _swapped() -> Case:
    """Every ball a body, in the scene of the simplified bearing."""
    scene = _dropped({}, 3).swap(bearing="detailed_caged")
    return Case("swapped", "detailed bearing put into the scene", scene, (REBOUND, PEAK))


def _drift() -> Case:
    """16 s of pendulum motion in a bushing without friction, from 30 degrees: all energies' sum stays."""
    angle = math.radians(30.0)
    rotor = {"speed": 0.0, "x": CLEARANCE * math.sin(angle), "y": -CLEARANCE * math.cos(angle)}
    energies = (
        "rotor.energy.kinetic",
        "rotor.energy.potential",
        "bearing.energy.potential",
        "bearing.energy.dissipated",
    )
    energy = DISK["mass"] * GRAVITY * CLEARANCE
    swing = energy * (1.0 - math.cos(angle))
    fastest = math.sqrt(2.0 * swing / DISK["mass"])
    scene = _disk(rotor, FRICTIONLESS, 16000)
    return Case(
        "drift",
        "16 s of pendulum motion",
        scene,
        (_Figure("energy", energies, swing),),
        theory=Expected((-energy * math.cos(angle),), fastest, CLEARANCE),
        steps=tuple(step for step in STEPS if step >= 2e-5),
        first=1e-4,
        long=True,
    )


def cases() -> dict[str, Case]:
    """All cases by name."""
    all_cases = (
        *(bounce(), *map(_stiffness, (1, 10, 100)), *map(_mass, (10, 1))),
        *(
            _whirl(),
            *map(_modes, (5, 10, 20)),
            _grazing(),
            _hold(),
            _stick(),
            _together(),
            _swapped(),
            _drift(),
        ),
    )
    return {case.name: case for case in all_cases}


ALL = "all"


def chosen(names: Sequence[str]) -> list[Case]:
    """The cases called `names`; without any those that are short, and all where ALL is one of them.

    Raises TouchdownError for an unknown name.
    """
    known = cases()
    for name in names:
        if name not in (*known, ALL):
            raise TouchdownError(f"there is no case {name}; {one_of(name, known)}")
    requested = known if ALL in names else names or [name for name, case in known.items() if not case.long]
    return [case for case in known.values() if case.name in requested]
