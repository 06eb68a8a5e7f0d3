"""A scene's rotor on what holds it: levitated, and resting on touchdown bearings.

The rotor is its model's, with as many modes as the scene has it keep. Bearings are measured on a rig, each
by itself, and what they stand on is told by the contract. Levitated, all that gives a force where the rotor
starts holds it; at rest, all that does not shut down.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.components.component import POSITION, SENSED, STIFFNESS
from ...master.coupling.connections import Attachment, housing_port
from ...master.coupling.simulation import opened
from ...master.coupling.system import System
from ...master.results.final_state import ReadableSystem
from ...master.scene.scene import Scene
from ...modelkit.gravity import gravity_across
from ...rotor.beams.shaft import Shaft
from ...rotor.modal.data import most_modes, seats
from ...rotor.modal.modes import RIGID_MODES, Basis, basis
from ...rotor.modal.supported import Foundation, HeldRotor, LinearBearing, static_stiffness
from ...rotor.modal.whirl_speeds import HeldModes, held_modes
from ...rotor.static_deflection import at_rest
from .rig import MAX_LOWERING, Answer, Place, Pressed, Rig, answers
from .rotor_in_bearings import RESTING
from .rotor_report import find_rotor


def balanced(scene: Scene, bodies: Iterable[str]) -> bool:
    """Whether all these components are rotors of elements or matrices, none with an unbalance."""
    try:
        unbalances = [u for body in bodies for u in scene_shaft(scene, body).unbalances]
        return not any(u.moment for u in unbalances)
    except TouchdownError:  # a rotor of another kind
        return False


SHUTDOWN, NO_SHUTDOWN = "shutdown_time", 1e9  # a parameter of magnetic bearings; s
CAMPBELL_LINES = 12  # followed over the speed
MAX_MODES = 16  # modes per plane


@dataclass(frozen=True)
class Bearing:
    """One of a scene's bearings as it holds the rotor, and how that was found."""

    name: str
    station: str  # of the rotor
    node: int
    parts: tuple[LinearBearing, ...]  # one that follows the journal, one that follows a sensor, or both
    sensor: str = ""  # the station that the latter looks at
    answers: tuple[Answer, ...] = ()  # by part, of one that holds the rotor where it starts
    load: float = 0.0  # N, that it was pressed with
    pressed: Pressed | None = None  # of one that the rotor lies on
    mount: str = ""  # what it stands on; "": the ground
    foundation: Foundation | None = None

    @property
    def statically(self) -> np.ndarray:
        """Stiffness (2, 2) with what it stands on in series, N/m, as if it looked where it acts."""
        return static_stiffness(self.parts)


@dataclass(frozen=True)
class SupportCondition:
    """The rotor held by some of its scene's bearings."""

    name: str  # "levitated" or "resting"
    bearings: tuple[Bearing, ...]
    held: HeldModes
    left_out: tuple[str, ...]  # a line for each bearing that does not hold it


@dataclass(frozen=True)
class RotorModel:
    """Data of a scene's rotor and bearings, once it is initialised."""

    scene: Scene
    body: str  # the rotor
    shaft: Shaft
    basis: Basis
    damping_ratio: float  # of the elastic modes
    gravity: float  # m/s2, across the shaft
    speed: float  # rad/s, counter-clockwise: that bearings are measured at
    journals: tuple[Attachment, ...]
    sensors: dict[str, dict[str, str]]  # by bearing: its port, and the rotor's that it sees
    places: dict[str, Place]  # by bearing
    mounts: dict[str, str]  # by bearing, COMPONENT.PORT
    foundations: dict[str, Foundation]  # by mount
    remarks: tuple[str, ...]  # what a run of the scene would say before its first step


def support_conditions(
    model: RotorModel, speeds: Sequence[float] | np.ndarray, load: float = 1.0
) -> tuple[list[SupportCondition], list[str]]:
    """Levitated and resting, where the rotor is, and a line for each of the two that it is not.

    speeds: rad/s, not negative; the one that modes are told at, then those of the diagram. load: of the
    touchdown bearings, over what they carry of the rotor's weight. Raises TouchdownError where nothing
    holds the rotor either way.
    """
    with opened(model.scene, in_process=True, listening=False) as idle:
        rigs = {a.bearing: _rig(model, idle, a) for a in model.journals}
        floating = {a.bearing: _floating(model, a, rigs[a.bearing]) for a in model.journals}
        lying = _lying(model, idle, rigs, floating, load)
    both = (("levitated", floating), (RESTING, lying))
    conditions = {name: _situation(model, name, found, speeds) for name, found in both}
    there = [one for one in conditions.values() if one is not None]
    if not there:
        raise TouchdownError(f"scene {model.scene.name}: no bearing holds its rotor")
    why = {name: "; ".join(f"{b} {reason}" for b, reason in found.items()) for name, found in both}
    return there, [f"not {name}: {why[name]}" for name, one in conditions.items() if one is None]


def _situation(
    model: RotorModel, name: str, found: Mapping[str, Bearing | str], speeds: Sequence[float] | np.ndarray
) -> SupportCondition | None:
    bearings = tuple(b for b in found.values() if isinstance(b, Bearing))
    if not bearings:
        return None
    parts = [part for b in bearings for part in b.parts]
    if model.speed < 0.0:  # forward is with the spin: seen from the other end
        flip = np.array([[1.0, -1.0], [-1.0, 1.0]])
        parts = [replace(p, stiffness=flip * p.stiffness, damping=flip * p.damping) for p in parts]
    rotor = HeldRotor(model.basis, parts, model.damping_ratio)
    left_out = tuple(f"{bearing} {why}" for bearing, why in found.items() if isinstance(why, str))
    return SupportCondition(name, bearings, held_modes(rotor, speeds, CAMPBELL_LINES), left_out)


# -- what the scene says -----------------------------------------------------------------------------


def rotor_model(scene: Scene) -> RotorModel:
    """A scene's rotor and bearings. Raises TouchdownError where the rotor is not of elements."""
    scene = scene.set({"run.scheme": "interface"})  # motion within a macro step as given
    with opened(scene, in_process=True, listening=False) as system:
        journals = tuple(a for a in system.attachments if a.on_journal)
        body = _body(scene, journals)
        shaft = _of_elements(scene, body)
        system.initialise()
        value = {name: system.value(f"{body}.{name}") for name in ("modes", "residual", "damping_ratio")}
        damping, seat_nodes = value["damping_ratio"], tuple(dict.fromkeys(seats(shaft)))
        inclined = system.value(inclination) if (inclination := f"{body}.inclination") in system else 0.0
        sensors = {a.bearing: _sensors(system, a) for a in journals}
        mounts = {a.bearing: m for a in journals if (m := housing_port(system, a.bearing)) is not None}
        return RotorModel(
            scene=scene,
            body=body,
            shaft=shaft,
            basis=_basis(shaft, int(value["modes"]), seat_nodes if value["residual"] else ()),
            damping_ratio=shaft.damping_ratio if damping < 0.0 else damping,
            gravity=gravity_across(system.value(f"{body}.gravity"), inclined),
            speed=system.value(f"{body}.speed"),
            journals=journals,
            sensors=sensors,
            places={a.bearing: _place(system, a, sensors[a.bearing], mounts) for a in journals},
            mounts=mounts,
            foundations={m: f for m in mounts.values() if (f := foundation_of(system, m)) is not None},
            remarks=tuple(system.remarks),
        )


def _basis(shaft: Shaft, modes: int, residual_at: tuple[int, ...]) -> Basis:
    """As the rotor has it; of more than `MAX_MODES` modes that many, and the flexibility of the others."""
    if RIGID_MODES <= modes <= MAX_MODES:
        return basis(shaft, modes, residual_at)
    return basis(
        shaft, min(MAX_MODES, most_modes(shaft)), tuple(dict.fromkeys(s.node for s in shaft.stations))
    )


def _of_elements(scene: Scene, body: str) -> Shaft:
    """`scene_shaft`, or what is said of a scene without one."""
    fmu = scene.components[body].fmu
    try:
        return scene_shaft(scene, body)
    except TouchdownError:
        if fmu.endswith(".toml"):
            raise
        raise TouchdownError(
            f"{body} of scene {scene.name} is the FMU {fmu}; this needs a rotor of beam elements: take a "
            "scene whose rotor is a .toml file, or one such as rotor1-9000"
        ) from None


def scene_shaft(scene: Scene, component: str) -> Shaft:
    """The component's rotor of elements. Raises TouchdownError where it is another FMU, or is gone."""
    fmu = scene.components[component].fmu
    path = scene.folder / fmu
    return find_rotor(str(path) if fmu.endswith(".toml") and path.is_file() else fmu)


def _body(scene: Scene, journals: Sequence[Attachment]) -> str:
    bodies = list(dict.fromkeys(a.body for a in journals))
    if len(bodies) != 1:
        which = f"its bearings hold {', '.join(bodies)}" if bodies else "no bearing holds one"
        raise TouchdownError(f"scene {scene.name} must have one rotor to look at; {which}")
    return bodies[0]


def _sensors(system: System, a: Attachment) -> dict[str, str]:
    """Ports by which a bearing sees the rotor elsewhere than at its journal, and what they see."""
    sensed: dict[str, str] = {}
    for c in system.connections:
        port, _, variable = c.input.rpartition(".")
        if (c.source, c.target) == (a.body, a.bearing) and variable in SENSED and "[" not in port:
            sensed[port] = c.output.rpartition(".")[0]
    return {port: source for port, source in sensed.items() if port != a.bearing_port}


def _place(system: System, a: Attachment, sensors: dict[str, str], mounts: dict[str, str]) -> Place:
    """Where the journal of a bearing starts, and what sees it."""

    def at(port: str) -> np.ndarray:
        return np.array([system.value(f"{port}.{axis}") for axis in POSITION])

    mount = mounts.get(a.bearing)
    housing = at(mount) if mount else np.zeros(2)
    return Place(at(a.body_end.title), housing, {p: at(f"{a.body}.{s}") for p, s in sensors.items()})


def foundation_of(system: ReadableSystem, mount: str) -> Foundation | None:
    """The body at COMPONENT.PORT, as the contract describes it; None: it does not give way."""
    names = [f"{mount}.{gain}" for gain in ("inv_m", STIFFNESS, "c_over_m")]
    inv_m, stiffness, damping = (system.value(name) if name in system else 0.0 for name in names)
    return Foundation(1.0 / inv_m, stiffness / inv_m, damping / inv_m, mount) if inv_m > 0.0 else None


# -- what the bearings do ----------------------------------------------------------------------------


def _rig(model: RotorModel, idle: System, a: Attachment) -> Rig:
    component = idle.components[a.bearing]
    if SHUTDOWN in component.variables:
        component.set({SHUTDOWN: NO_SHUTDOWN})
    step = model.scene.run.macro_step * idle.every[a.bearing]
    return Rig(component, a.bearing_port, model.places[a.bearing], step)


def _floating(model: RotorModel, a: Attachment, rig: Rig) -> Bearing | str:
    """A bearing about the place where the rotor starts, spinning; or that it gives no force there."""
    sensors = model.sensors[a.bearing]
    rig.spin = model.speed
    found = answers(rig, bool(sensors))
    if not found:
        return "gives no force where the rotor starts"
    node, sensor = model.shaft.node(a.body_port), ""
    if any(answer.sensed for answer in found):
        sensor = _looks_at(model, a.bearing, tuple(sensors.values()))
    mount, foundation = _stands_on(model, a)
    parts = tuple(
        LinearBearing(
            node,
            answer.law.stiffness,
            answer.law.damping,
            answer.law.lag,
            model.shaft.node(sensor) if answer.sensed else None,
            foundation,
        )
        for answer in found
    )
    return Bearing(
        a.bearing, a.body_port, node, parts, sensor, answers=found, mount=mount, foundation=foundation
    )


def _looks_at(model: RotorModel, bearing: str, stations: Sequence[str]) -> str:
    """The station that a bearing sees the rotor at. Raises TouchdownError where there are several."""
    if len({model.shaft.node(station) for station in stations}) > 1:
        raise TouchdownError(
            f"{bearing} of scene {model.scene.name} sees the rotor at {', '.join(stations)}: "
            "the effects of the sensors cannot be told apart; give it one sensor"
        )
    return stations[0]


def _stands_on(model: RotorModel, a: Attachment) -> tuple[str, Foundation | None]:
    mount = model.mounts.get(a.bearing, "")
    return mount, model.foundations.get(mount)


def _lying(
    model: RotorModel,
    idle: System,
    rigs: Mapping[str, Rig],
    floating: Mapping[str, Bearing | str],
    load: float,
) -> dict[str, Bearing | str]:
    """Bearings as the rotor rests on them once it is shut down; or why one does not hold it."""
    lying: dict[str, Bearing | str] = {}
    pressing: list[Attachment] = []
    for a in model.journals:
        found = floating[a.bearing]
        if SHUTDOWN in idle.components[a.bearing].variables:
            lying[a.bearing] = "is shut down"
        elif isinstance(found, Bearing):
            lying[a.bearing] = found
        else:
            pressing.append(a)
    shares = _shares(model, pressing, [b for b in lying.values() if isinstance(b, Bearing)])
    for a in pressing:
        lying[a.bearing] = _pressed(model, a, rigs[a.bearing], load * shares[a.bearing])
    return lying


def _shares(
    model: RotorModel, pressing: Sequence[Attachment], holding: Sequence[Bearing]
) -> dict[str, float]:
    """Of the rotor's weight (N), by bearing: what rigid ones carry; those of one place share it."""
    nodes = {a.bearing: model.shaft.node(a.body_port) for a in pressing}
    supports = dict.fromkeys(nodes.values(), np.inf)
    others = {b.node: float(b.statically[1, 1]) for b in holding if b.node not in supports}
    supports |= {node: k for node, k in others.items() if k > 0.0}  # a damper carries nothing
    if len(supports) < 2:  # it would tip; nothing is known of what holds it there
        return dict.fromkeys(nodes, 0.0)
    try:
        reactions = at_rest(model.shaft, list(supports.items()), model.gravity).reactions
    except TouchdownError as error:
        raise TouchdownError(
            f"scene {model.scene.name}: how its rotor lies is not known: {error}"
        ) from None
    on = dict(zip(supports, reactions.tolist(), strict=True))
    every = list(nodes.values())
    return {name: on[node] / every.count(node) for name, node in nodes.items()}


def _pressed(model: RotorModel, a: Attachment, rig: Rig, load: float) -> Bearing | str:
    """A bearing under `load` (N), on its foundation; or why it carries none."""
    if load <= 0.0:
        return "carries none of the rotor's weight"
    pressed = rig.pressed(load)
    if pressed is None:
        return f"lets the journal sink by more than {1e3 * MAX_LOWERING:g} mm"
    mount, foundation = _stands_on(model, a)
    part = LinearBearing(
        model.shaft.node(a.body_port),
        np.diag([pressed.across, pressed.along]),
        np.diag([0.0, pressed.damping]),
        foundation=foundation,
    )
    return Bearing(
        a.bearing, a.body_port, part.node, (part,),
        load=load, pressed=pressed, mount=mount, foundation=foundation,
    )  # fmt: skip
