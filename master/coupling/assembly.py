"""A scene's components loaded, their parameters set, and wired up to a system."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress

import numpy as np

from ...fmus.recipes import bore_of, is_angled, preset
from ...modelkit.units import is_bare
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError, one_of
from ..common.text import joined
from ..components.component import Component, FmiType, Setting, check_value, elements, value_of
from ..scene.plausible import Heavy, PlausibleSeat, plausibility_warnings, weight_warnings
from ..scene.scene import INCLINATION, ComponentSpec, Scene
from ..scene.schemes import Scheme
from .bonds.bond import find_bonds
from .connections import (
    COMMAND,
    Attachment,
    Connection,
    attachment,
    check_command,
    check_connections,
    connection,
    control_connections,
    controlled,
    port_connections,
    recognised,
    require_real,
    sensor_connections,
    speed_connections,
)
from .grades import ungraded
from .idle import idle_settings
from .loop.span import steps_in, time_zero
from .system import System

# Units of what is looked at; a third-party FMU may have rpm
UNSCALED_UNITS = (None, "", "1", "m", "rad", "rad/s", "m/s2", "N/m", "N", "kg")
FAR_LONGER = 10.0  # than the step that an FMU proposes, which is not a bound; above, it is said
STEP_MATCH = 1e-6  # of a declared step; what differs by less is the same
GRAVITY = "gravity"
JACOBI = "jacobi"  # sequence in which all step at once, and give at the end of their own steps
SAMPLE_TIME, TICK = "sample_time", "tick"  # of an actuator: s, 0: it does not sample; sample to come
CLOCK, OWN = "clock", 1.0  # of a controller: whose samples it uses, and its own, each `SAMPLE_TIME`
BASE, COURSE = "base.", "base.course.form"  # of a body: the base's motion, and its course, 0: none
# Of an actuator: V, from a DC link; J, that it took of it; settings of one that no link feeds
LINK_VOLTAGE, LINK_ENERGY, SUPPLY = "link_voltage", "link_energy", "supply."
ORDER, LEAD = "interface.order", "interface.lead"  # parameters that follow from the scheme


Hearing = Callable[[Mapping[str, Component], Sequence[Attachment]], dict[str, Component]]


def assemble_system(scene: Scene, load: Callable[[str, str], Component], hear: Hearing) -> System:
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
    texts: dict[tuple[str, str], str] = {}
    left_out: list[str] = []
    for name, component in components.items():
        spec = ungraded(scene, component)
        inherited = _inherited(component, spec)
        left_out += _left_out(scene, component, [key for key in spec.inherited if key not in inherited])
        values = _settings(component, spec, inherited, scheme) | _inclined(component, scene)
        component.set(values)
        left_out += _of_another_bearing(name, spec)
        for key, value in values.items():
            if isinstance(value, str):
                texts[name, key] = value
            else:
                settings[name, key] = value
    connections = _connections(scene, scheme, components)
    attachments = recognised(connections, components)
    bonds = find_bonds(scene.bond, connections, attachments, components)
    if scheme.lead:
        _require_lead(attachments, components)
    every = {name: spec.every for name, spec in scene.components.items()}
    periods = {name: spec.sampled for name, spec in scene.components.items() if spec.sampled}
    clocks = _check_loops(scene, components, connections, settings)
    seats = [_seat(a, scene, components, settings) for a in attachments if a.on_journal]
    heavy = [_heavy(name, component, settings) for name, component in components.items()]
    remarks = [
        *scene.remarks,
        *left_out,
        *declared_steps(scene, components),
        *_early(scene, attachments, connections),
        *clocks,
        *_fed_by_links(scene, connections),
        *_apart(components, settings),
        *idle_settings(scene, components, attachments, settings),
    ]
    remarks += plausibility_warnings(seats)
    remarks += weight_warnings(one for one in heavy if one is not None)
    components = hear(components, attachments)
    start = scene.run.start_time
    system = System(
        components, attachments, connections, settings, every, remarks, bonds, start, None, periods, texts
    )
    system.stop = _stop_time(scene, system)
    return system


def _stop_time(scene: Scene, system: System) -> float:
    """When the last step of any component ends (s)."""
    run, specs = scene.run, scene.components.values()
    zero = time_zero(scene, system)
    end = (run.start_time if zero is None else zero) + run.duration
    steps = steps_in(end - run.start_time, run.macro_step)
    last = max(-(-steps // spec.every) * spec.every for spec in specs) * run.macro_step
    sampled = max(spec.sampled for spec in specs)  # a step that begins before the end may end after it
    return run.start_time + (max(last, steps * run.macro_step + sampled) if sampled else last)


def _check_loops(
    scene: Scene,
    components: Mapping[str, Component],
    connections: Sequence[Connection],
    settings: Mapping[tuple[str, str], float],
) -> list[str]:
    """Lines on controllers whose samples may not be their actuators'.

    Raises TouchdownError where they are not, and where a set point that acts is fed by nothing.
    """

    def value(name: str, key: str) -> float:
        variable = components[name].variables.get(key)
        return settings.get((name, key), variable.start if variable else None) or 0.0

    loops, lines = controlled(connections), list[str]()
    for name, spec in scene.components.items():
        actuators = [actuator for controller, actuator in loops if controller == name]
        if spec.sampled:
            _check_sampled(name, spec.sampled, scene.run.macro_step, actuators)
        for actuator in actuators:
            if COMMAND in components[actuator].variables:
                check_command(connections, actuator, value(actuator, COMMAND))
            ticks = any(c.target == name and c.output == TICK for c in connections)
            period = value(actuator, SAMPLE_TIME)
            if spec.sampled or period:
                lines += _clock(scene, components[name], actuator, period, ticks)
            own = value(name, SAMPLE_TIME)
            if value(name, CLOCK) == OWN and 0.0 < own < period * (1.0 - STEP_MATCH):
                lines.append(
                    f"{name}.{SAMPLE_TIME} = {own:g} s is shorter than {actuator}.{SAMPLE_TIME} = "
                    f"{period:g} s, and there are no samples between; set {period:g} s"
                )
    return lines


def _check_sampled(name: str, period: float, step: float, actuators: Sequence[str]) -> None:
    """Raise TouchdownError where a component's `sampled` (s) cannot be: an actuator holds what it gives."""
    if period < step * (1.0 - STEP_MATCH):
        raise TouchdownError(
            f"{name}.sampled = {period:g} s is shorter than the macro step {step:g} s; take a smaller one"
        )
    if not actuators:
        raise TouchdownError(
            f"{name}.sampled: {name} controls nothing (`control` of the scene); give it every = "
            f"{max(1, round(period / step))}, macro steps that it takes in one"
        )


def _clock(scene: Scene, controller: Component, actuator: str, period: float, ticks: bool) -> Iterator[str]:
    """A line on a controller that may take other samples than its actuator, every `period` (s; 0: none).

    ticks: whether it is told the samples' numbers. Raises TouchdownError where it takes others for sure.
    """
    name, run = controller.name, scene.run
    spec = scene.components[name]
    step = spec.step(run.macro_step)
    same = abs(step - period) <= STEP_MATCH * period
    if spec.sampled and not same:
        sampling = f"{actuator}.{SAMPLE_TIME} is {period:g} s" if period else f"{actuator} does not sample"
        raise TouchdownError(
            f"{name}.sampled = {step:g} s, and {sampling}: the actuator takes the samples, so it must "
            "have the same time"
        )
    if run.macro_step > period * (1.0 + STEP_MATCH):
        return  # the actuator takes no such steps
    if not same and (step > period or not ticks):
        missed = "misses samples"
        again = "answers each sample several times, which is another control law"
        raise TouchdownError(
            f"{name} is stepped every {step:g} s, and {actuator}.{SAMPLE_TIME} is {period:g} s: it "
            f"{missed if step > period else again}; set {name}.sampled = {period:g} s"
        )
    undivided = ticks or spec.sampled or spec.every > 1 or not controller.any_step
    if not undivided and (run.impact_step or run.whirl_halvings):
        yield (
            f"{name} takes each of its steps for a sample; where macro steps are divided (run.impact_step, "
            f"run.whirl_halvings) it takes more than {actuator} has. Set {name}.sampled = {period:g} s"
        )


def _fed_by_links(scene: Scene, connections: Sequence[Connection]) -> Iterator[str]:
    """Lines on own supplies of actuators that a DC link feeds, and on what the link is not told."""
    told = {c.source for c in connections if c.output == LINK_ENERGY}
    for c in connections:
        if c.input != LINK_VOLTAGE:
            continue
        if own := [f"{c.target}.{key}" for key in scene.components[c.target].set if key.startswith(SUPPLY)]:
            do, them = ("do", "them") if len(own) > 1 else ("does", "it")
            yield f"{', '.join(own)} {do} nothing, as {c.source} feeds {c.target}; leave {them} out"
        if c.target not in told:
            yield (
                f"{c.source} is not told what {c.target} takes, and does not run empty by it; connect "
                f"{c.target}.{LINK_ENERGY}"
            )


def _apart(components: Mapping[str, Component], settings: Mapping[tuple[str, str], float]) -> Iterator[str]:
    """A line on bodies that do not stand on one base: its motion is not alike in all that know it."""
    motions: dict[str, dict[str, float | None]] = {}
    for name, component in components.items():
        if COURSE in component.variables:
            starts = {key: v.start for key, v in component.variables.items() if key.startswith(BASE)}
            values = {key: settings.get((name, key), start) for key, start in starts.items()}
            moves = values[COURSE] and (values.get(f"{BASE}x") or values.get(f"{BASE}y"))
            motions[name] = values if moves else {}
    first, *others = motions.values() or [{}]
    if any(one != first for one in others):
        still = [name for name, values in motions.items() if not values]
        rest = f"; it stands still in {joined(still)}" if still else ""
        yield f"{BASE}* is not alike in {joined(motions)}, which stand on one base{rest}; set all alike"


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
            needed = [axis for axis in gap.motions if port == gap.at or axis in "xyz"]
            if not {f"{inner}.{axis}" for axis in needed} <= there.keys():
                ends = f".{needed[-1]}"
                ports = sorted({one.removesuffix(ends) for one in there if one.endswith(ends)})
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
                f"{step:g} s is not a multiple of that"
            )
        if proposed and not component.any_step and abs(step / proposed - 1.0) > STEP_MATCH:
            yield (
                f"{name} takes steps of {proposed:g} s alone (stepSize of its FMU's DefaultExperiment, and "
                f"canHandleVariableCommunicationStepSize = false); its macro step is {step:g} s"
            )
        elif proposed and step > FAR_LONGER * proposed:
            yield (
                f"{name} was made for steps of {proposed:g} s (stepSize of its FMU's DefaultExperiment); "
                f"its macro step of {step:g} s is far longer"
            )


def _seat(
    a: Attachment,
    scene: Scene,
    components: Mapping[str, Component],
    settings: Mapping[tuple[str, str], float],
) -> PlausibleSeat:
    """A bearing and its journal as they were set, to be looked at beside each other."""

    def values(name: str) -> dict[str, float]:
        """Parameters in SI, where they are set or the component says its own."""
        variables = components[name].variables.items()
        starts = {
            n: v.start
            for n, v in variables
            if v.causality is Causality.PARAMETER and v.unit in UNSCALED_UNITS
        }
        return {n: settings.get((name, n), start) for n, start in starts.items() if start is not None}

    chosen, body, bearing_values = scene.components[a.bearing].preset, values(a.body), values(a.bearing)
    moves, points = body.get("axial"), range(1, int(body.get("thrust_points", 0.0)) + 1)
    steady = body.get("axial_load", 0.0)
    rows = components[a.bearing].variables.get("arrangement")
    return PlausibleSeat(
        bearing=a.bearing,
        values=bearing_values,
        designation=chosen and chosen.rpartition(":")[2],
        bore=bore_of(chosen) if chosen else None,
        is_angled=bool(chosen) and is_angled(chosen),
        body=a.body,
        speed=body.get("speed"),
        bare_speed=is_bare(scene.components[a.body].set.get("speed")),
        gravity=body.get(GRAVITY),
        inclination=body.get(INCLINATION),
        axial=None if moves is None else moves == 1.0,
        mass=body.get("mass"),
        thrusts=[steady + body.get(f"thrust[{k}].force", 0.0) for k in points] or [steady],
        arrangement=next((w for w, n in rows.choices.items() if n == bearing_values.get(rows.name)), "")
        if rows
        else "",
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
    connections += speed_connections(scene.control, connections, components)
    check_connections(connections, components)
    for c in connections:
        whole = c.input.rpartition("[")[0]  # the array that it is an element of
        if not scene.components[c.target].set.keys().isdisjoint((c.input, whole)):
            raise TouchdownError(f"{c.target_name} cannot be set: it is connected to {c.source_name}")
    return connections


def _inherited(component: Component, spec: ComponentSpec) -> dict[str, Setting]:
    """Settings of the scene's component that the one swapped in can take over."""
    values: dict[str, Setting] = {}
    for key, value in spec.inherited.items():
        with suppress(TouchdownError):  # not the user's mistake
            values[key] = checked_value(component, key, value)
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
    component: Component, spec: ComponentSpec, inherited: Mapping[str, Setting], scheme: Scheme
) -> dict[str, Setting]:
    """Values of a component's parameters and inputs: of preset and swap as far as it has them, then set."""
    known = _preset(component.name, spec.preset)
    optional = {key: value for key, value in known.items() if key in component.variables} | dict(inherited)
    settings = {**optional, **dict(_spread(component, spec.set))}
    values = {key: checked_value(component, key, value) for key, value in settings.items()}
    for key, value in ((ORDER, scheme.order), (LEAD, int(scheme.lead))):
        if key in spec.set:
            raise TouchdownError(f"{component.name}.{key} follows from the scheme; set run.scheme instead")
        if key in component.variables:
            values[key] = value
    return values


def _spread(component: Component, settings: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Settings, those of whole arrays as those of their elements. Raises TouchdownError for other sizes."""
    for key, value in settings.items():
        if key in component.variables or not isinstance(value, (list, tuple, np.ndarray)):
            yield key, value
            continue
        names, values = elements(component.variables, key), np.ravel(np.asarray(value, object)).tolist()
        if not names:
            component.variable(key)  # raises: there is none
        if len(names) != len(values):
            raise TouchdownError(
                f"{component.name}.{key} has {len(names)} elements, and {len(values)} values are given"
            )
        yield from zip(names, values, strict=True)


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
    except TouchdownError as error:
        raise TouchdownError(f"{component}.preset: {error}") from None


def _require_lead(attachments: Iterable[Attachment], components: Mapping[str, Component]) -> None:
    for a in attachments:
        bearing = components[a.bearing]
        if LEAD not in bearing.variables:
            raise TouchdownError(
                f"{a.bearing} ({bearing.origin}) cannot lead: it has no parameter {LEAD}; choose a "
                "scheme that steps bearings first"
            )


def checked_value(component: Component, name: str, entered: object) -> Setting:
    """A setting's value, in SI or text. Raises TouchdownError where the component cannot take it."""
    variable = component.variable(name)
    if variable.kind in (FmiType.BINARY, FmiType.CLOCK):
        raise TouchdownError(
            f"{component.name}.{name} is of the type {variable.kind}; only numbers and texts can be set"
        )
    if not variable.settable:
        kind = f"the causality {variable.causality} (constant, or initial is neither exact nor approx)"
        if variable.structural:
            kind = "the causality structuralParameter: arrays keep the sizes that they start with,"
        raise TouchdownError(f"{component.name}.{name} has {kind} and cannot be set")
    value = value_of(f"{component.name}.{variable.name}", variable, entered)
    if not isinstance(value, str):
        check_value(component, variable, value)
    return value
