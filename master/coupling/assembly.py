"""A scene's components loaded, their parameters set, and wired up to a system."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress

from ...fmus.recipes import bore_of, preset
from ...modelkit.model import ModelError
from ...modelkit.units import is_bare
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError, one_of
from ..components.component import SETTABLE, THRUST, Component, check_value, value_of
from ..scene.plausible import Heavy, Seat, plausibility_warnings, weight_warnings
from ..scene.scene import INCLINATION, ComponentSpec, Scene
from ..scene.schemes import Scheme
from .bonds.bond import find_bonds
from .connections import (
    Attachment,
    Connection,
    Controlled,
    attachment,
    check_connections,
    connection,
    control_connections,
    controlled,
    port_connections,
    recognised,
    require_real,
    sensor_connections,
)
from .idle import idle_settings
from .system import System

# Units of what is looked at; an FMU of others' may have rpm
UNSCALED_UNITS = (None, "", "1", "m", "rad", "rad/s", "m/s2", "N/m")
FAR_LONGER = 10.0  # than the step that an FMU proposes, which is no bound; above, it is said
STEP_MATCH = 1e-6  # of a declared step; what differs by less is the same
GRAVITY = "gravity"
JACOBI = "jacobi"  # sequence in which all step at once, and give at the end of their own steps
SAMPLE_TIME = "sample_time"  # s, of an actuator; 0: it does not sample
ORDER, LEAD = "interface.order", "interface.lead"  # parameters that follow from the scheme


Hearing = Callable[[Mapping[str, Component], Sequence[Attachment]], dict[str, Component]]


def assemble(scene: Scene, load: Callable[[str, str], Component], hear: Hearing) -> System:
    """Load a scene's components with load(name, fmu), and wire them up as its scheme has it.

    hear(components, attachments) gives components that tell more than they would by themselves.
    Raises TouchdownError where a component is missing, a setting cannot be, or the ports do not fit.
    """
    components: dict[str, Component] = {}
    try:
        for name, spec in scene.components.items():
            components[name] = load(name, spec.fmu)
            components[name].rename(spec.names)
        return _wired(scene, components, hear)
    except BaseException:
        for component in components.values():
            component.close()
        raise


def _wired(scene: Scene, components: dict[str, Component], hear: Hearing) -> System:
    scheme = scene.run.scheme
    _check_zero(scene, components)
    _check_gaps(scene, components)
    settings: dict[tuple[str, str], float] = {}
    left_out: list[str] = []
    for name, component in components.items():
        spec = scene.components[name]
        inherited = _inherited(component, spec)
        left_out += _left_out(scene, component, [key for key in spec.inherited if key not in inherited])
        values = _settings(component, spec, inherited, scheme) | _inclined(component, scene)
        component.set(values)
        left_out += _of_another_bearing(name, spec)
        settings |= {(name, key): value for key, value in values.items()}
    connections = _connections(scene, scheme, components)
    attachments = recognised(connections, components)
    bonds = find_bonds(scene.bond, connections, attachments, components)
    if scheme.lead:
        _require_lead(attachments, components)
    step = scene.run.macro_step
    every = {name: spec.every for name, spec in scene.components.items()}
    periods = {name: spec.sampled for name, spec in scene.components.items() if spec.sampled}
    for name, period in periods.items():
        _check_sampled(name, period, step, controlled(connections), components, settings)
    seats = [_seat(a, scene, components, settings) for a in attachments if a.on_journal]
    heavy = [_heavy(name, component, settings) for name, component in components.items()]
    remarks = [*left_out, *declared_steps(scene, components), *_early(scene, attachments, connections)]
    remarks += idle_settings(scene, components, attachments, settings)
    remarks += plausibility_warnings(seats)
    remarks += weight_warnings(one for one in heavy if one is not None)
    components = hear(components, attachments)
    start = scene.run.start_time
    return System(components, attachments, connections, settings, every, remarks, bonds, start, periods)


def _check_sampled(
    name: str,
    period: float,
    step: float,
    loops: Sequence[Controlled],
    components: Mapping[str, Component],
    settings: Mapping[tuple[str, str], float],
) -> None:
    """Raise TouchdownError where a component's `sampled` (s) does not go with what it controls.

    What it makes of a sample acts at the next tick only because its actuator samples, and waits, itself.
    """
    actuators = [loop.actuator for loop in loops if loop.controller == name]
    if period < step * (1.0 - STEP_MATCH):
        raise TouchdownError(
            f"{name}.sampled = {period:g} s is shorter than the macro step {step:g} s; take a smaller one"
        )
    if not actuators:
        raise TouchdownError(
            f"{name}.sampled: {name} controls nothing (`control` of the scene); give it every = "
            f"{max(1, round(period / step))}, macro steps that it takes in one"
        )
    for actuator in actuators:
        variable = components[actuator].variables.get(SAMPLE_TIME)
        own = settings.get((actuator, SAMPLE_TIME), variable.start if variable else None) or 0.0
        if abs(own - period) > STEP_MATCH * period:
            what = f"{actuator}.{SAMPLE_TIME} is {own:g} s" if variable else f"{actuator} does not sample"
            raise TouchdownError(
                f"{name}.sampled = {period:g} s, and {what}: the actuator takes the samples, so it must "
                "have the same time"
            )


def _early(
    scene: Scene, attachments: Sequence[Attachment], connections: Iterable[Connection]
) -> Iterator[str]:
    """Components whose outputs act before their own, longer step ends, a line each."""
    attached = {name for a in attachments for name in (a.bearing, a.body)}
    gives = {c.source for c in connections}
    for name, spec in scene.components.items():
        if spec.every > 1 and name in gives - attached and scene.run.scheme.sequence != JACOBI:
            early = (spec.every - 1) * scene.run.macro_step
            yield (
                f"{name} takes {spec.every} macro steps in one; what it gives acts from the end of the "
                f"first on, {early:g} s before the end of its own, unless it holds it back itself. A "
                "controller has `sampled` instead"
            )


def _check_gaps(scene: Scene, components: Mapping[str, Component]) -> None:
    """Raise TouchdownError for a gap at a place that no component tells."""
    for gap in scene.gaps:
        for port in filter(None, (gap.at, gap.stator)):
            name, _, inner = port.partition(".")
            if name not in components:
                raise TouchdownError(f"gap {gap.name}: {port}: {one_of(name, components)}")
            there = components[name].variables
            if not {f"{inner}.x", f"{inner}.y"} <= there.keys():
                ports = sorted({one.rpartition(".")[0] for one in there if one.endswith(".x")} - {""})
                raise TouchdownError(
                    f"gap {gap.name}: {name} has no place {inner}; {one_of(inner, ports)}. Each station "
                    "of a rotor's file is a place"
                )


def declared_steps(scene: Scene, components: Mapping[str, Component]) -> Iterator[str]:
    """Lines on steps that FMUs declare and that do not fit the macro step."""
    for name, component in components.items():
        step = scene.components[name].step(scene.run.macro_step)
        inner, proposed = component.inner_step, component.made_for_step
        if inner and (
            step < inner * (1.0 - STEP_MATCH) or abs(step / inner - round(step / inner)) > STEP_MATCH
        ):
            yield (
                f"{name} steps by {inner:g} s inside (fixedInternalStepSize of its FMU); its macro step of "
                f"{step:g} s is no multiple of that"
            )
        if proposed and step > FAR_LONGER * proposed:
            yield (
                f"{name} was made for steps of {proposed:g} s (stepSize of its FMU's DefaultExperiment); "
                f"its macro step of {step:g} s is far longer"
            )


def _seat(
    a: Attachment,
    scene: Scene,
    components: Mapping[str, Component],
    settings: Mapping[tuple[str, str], float],
) -> Seat:
    """A bearing and its journal as they were set, to be looked at beside each other."""

    def values(name: str) -> dict[str, float]:
        """Parameters in SI, where they are set or the component says its own."""
        variables = components[name].variables.items()
        own = {
            n: v.start
            for n, v in variables
            if v.causality is Causality.PARAMETER and v.unit in UNSCALED_UNITS
        }
        return {n: settings.get((name, n), start) for n, start in own.items() if start is not None}

    chosen, moves = scene.components[a.bearing].preset, values(a.body).get("axial")
    return Seat(
        bearing=a.bearing,
        values=values(a.bearing),
        designation=chosen and chosen.rpartition(":")[2],
        bore=bore_of(chosen) if chosen else None,
        body=a.body,
        speed=values(a.body).get("speed"),
        bare_speed=is_bare(scene.components[a.body].set.get("speed")),
        gravity=values(a.body).get(GRAVITY),
        inclination=values(a.body).get(INCLINATION),
        takes_thrust=f"{a.bearing_port}.{THRUST}" in components[a.bearing].variables,
        axial=None if moves is None else moves == 1.0,
    )


def _heavy(name: str, component: Component, settings: Mapping[tuple[str, str], float]) -> Heavy | None:
    """A component's gravity as it was set, and where that points; None: it has no weight."""

    def value(key: str) -> float | None:
        known = component.variables.get(key)
        return None if known is None else settings.get((name, key), known.start)

    return None if value(GRAVITY) is None else Heavy(name, value(GRAVITY) or 0.0, value(INCLINATION))


def _check_zero(scene: Scene, components: Mapping[str, Component]) -> None:
    """See that what times count from is a time, where it says so."""
    head, _, tail = (scene.zero or "").partition(".")
    swapped = head in components and scene.components[head].instead_of
    if head not in components or (swapped and _lacks(components[head], f"{head}.{tail}")):
        return
    unit = components[head].variable(tail).unit
    if unit not in (None, "", "s"):
        raise TouchdownError(
            f"zero = {scene.zero} is measured in {unit}; it must be a time, such as amb.shutdown_time"
        )


def _connections(scene: Scene, scheme: Scheme, components: Mapping[str, Component]) -> list[Connection]:
    """All that the scene attaches, senses and connects, checked."""
    attached = [attachment(pair, components) for pair in scene.attach]
    ports = [c for a in attached for c in port_connections(a, components, scheme)]
    ports += [c for pair in scene.sense for c in sensor_connections(pair, components)]
    ports += control_connections(scene.control, components)
    require_real(ports, components, "what crosses at a port")
    declared = [wire for bond in scene.bond for wire in bond.wires]
    require_real((connection(wire, components) for wire in declared), components, "a bond")
    wires = dict.fromkeys([*scene.connect, *declared])  # a bond's may stand among the others, too
    connections = [*ports, *(connection(wire, components) for wire in wires)]
    check_connections(connections, components)
    for c in connections:
        if c.input in scene.components[c.target].set:
            raise TouchdownError(f"{c.target_name} cannot be set: it is connected to {c.source_name}")
    return connections


def _inherited(component: Component, spec: ComponentSpec) -> dict[str, float]:
    """Settings of the scene's component that the one swapped in can take over."""
    values: dict[str, float] = {}
    for key, value in spec.inherited.items():
        with suppress(TouchdownError):  # not the user's mistake
            values[key] = checked(component, key, value)
    return values


def _left_out(scene: Scene, component: Component, settings: Sequence[str]) -> list[str]:
    """A line on settings that a swapped component does not take over, or none."""
    spec = scene.components[component.name]
    if not spec.instead_of:
        return []
    lost = [f"{component.name}.{key}" for key in settings]
    if scene.zero is not None and _lacks(component, scene.zero):
        origin = "t = 0" if scene.run.start_time else "the start"
        lost.append(f"zero = {scene.zero}, so times count from {origin}")
    if any(_lacks(component, name) for name in scene.energy_scale):
        lost.append("energy_scale, so energies are in J only")
    what = f"{component.name} is {spec.fmu} instead of {spec.instead_of}, and does not take over"
    return [f"{what} {'; '.join(lost)}"] if lost else []


# What scenes set of a bearing that another bearing would have otherwise
OF_A_BEARING = (
    *("contact.stiffness", "contact.exponent", "contact.load", "contact.length", "contact.depth"),
    *("contact.expected_indentation", "balls.expected_indentation", "ring.harmonics", "damping"),
)


def _of_another_bearing(name: str, spec: ComponentSpec) -> list[str]:
    """A line on settings that stay where another bearing is set beside the scene, or none."""
    stays = [key for key in OF_A_BEARING if key in spec.set and key not in spec.own]
    if "preset" not in spec.own or not stays:
        return []
    return [
        f"{name}.preset = {spec.preset} is set beside the scene, which has {', '.join(stays)} for another "
        "bearing, and keeps it; set that, too, or leave it out of the scene"
    ]


def _lacks(component: Component, name: str) -> bool:
    """Whether COMPONENT.VARIABLE is to be its, and is not there."""
    head, _, tail = name.partition(".")
    return head == component.name and tail not in component.variables


def _settings(
    component: Component, spec: ComponentSpec, inherited: Mapping[str, float], scheme: Scheme
) -> dict[str, float]:
    """Values of a component's parameters and inputs: of preset and swap as far as it has them, then set."""
    known = _preset(component.name, spec.preset)
    optional = {key: value for key, value in known.items() if key in component.variables} | dict(inherited)
    values = {key: checked(component, key, value) for key, value in {**optional, **spec.set}.items()}
    for key, value in ((ORDER, scheme.order), (LEAD, int(scheme.lead))):
        if key in spec.set:
            raise TouchdownError(f"{component.name}.{key} follows from the scheme; set run.scheme instead")
        if key in component.variables:
            values[key] = value
    return values


def _inclined(component: Component, scene: Scene) -> dict[str, float]:
    """The machine's inclination (rad) for a component that takes one; nothing where the scene has none.

    Raises TouchdownError where the component's own is set beside it.
    """
    if scene.inclination is None or INCLINATION not in component.variables:
        return {}
    if INCLINATION in scene.components[component.name].set:
        raise TouchdownError(
            f"{component.name}.{INCLINATION} is set beside the scene's, which holds for the whole machine; "
            f"leave one of them out (a run takes --set {INCLINATION}=...)"
        )
    return {INCLINATION: scene.inclination}


def _preset(component: str, name: str | None) -> dict[str, float]:
    """Values of a bearing of the catalogue, or of a file, which may have changed since."""
    try:
        return preset(name) if name else {}
    except ModelError as error:
        raise TouchdownError(f"{component}.preset: {error}") from None


def _require_lead(attachments: Iterable[Attachment], components: Mapping[str, Component]) -> None:
    for a in attachments:
        bearing = components[a.bearing]
        if LEAD not in bearing.variables:
            raise TouchdownError(
                f"{a.bearing} ({bearing.origin}) cannot lead: it has no parameter {LEAD}; choose a "
                "scheme that steps bearings first"
            )


def checked(component: Component, name: str, given: object) -> float:
    """A setting's value in SI. Raises TouchdownError where the component cannot take it."""
    variable = component.variable(name)
    if variable.kind not in SETTABLE:
        raise TouchdownError(
            f"{component.name}.{variable.name} is of the type {variable.kind}; only numbers can be set"
        )
    if not variable.settable:
        raise TouchdownError(
            f"{component.name}.{name} has the causality {variable.causality} and cannot be set"
        )
    value = value_of(component, variable, given)
    check_value(component, variable, value)
    return value
