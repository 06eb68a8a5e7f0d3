"""A machine's scene as text: TOML with a comment beside each value that a designer may want to change."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

from ...bearings.angular.angular_row import TANDEM
from ...bearings.catalogue import BALL_MATERIALS, Bearing
from ...bearings.catalogue.drag import COEFFICIENTS, kind, rolling_resistance
from ...bearings.catalogue.landing import landing
from ...bearings.catalogue.load_sharing import HELD, RingSeat, ball_loads, harmonics_for, harmonics_worth
from ...bearings.catalogue.spinning import spun
from ...master.common.text import MM, RPM, UM, percent
from ...master.scene.plausible import MAX_BORE_SPEED
from ...master.scene.requirements import KINDS, SIDES
from .controlled_text import controlled_events, controlled_head, controlled_text, controller
from .machine_design import (
    FORCE_LIMIT_RATIO,
    GRAVITY,
    LEVITATION_DAMPING,
    LEVITATION_FREQUENCY,
    MAX_SPEED_RATIO,
    RING_DAMPING,
    STEEL_LOSS,
    Design,
    MountFile,
    Support,
    rounded,
)
from .mount_rules import HERTZ, heading, holding, model, stiffness_text

IN_SPACE = "angular_simplified"
RUN = (
    'duration = "2 s"  # at most',
    'until = "settled"  # ends earlier once all seats have; "end" goes on for the whole duration',
)
RUN_ON = ('duration = "0.6 s"',)
LOOSE_SEAT = RingSeat(play=10e-6)  # as a sliding fit may be


def scene_text(design: Design) -> str:
    """The scene's file. Each value stands once: what all bearings share in [set], at the end."""
    magnetic = (
        _magnetic(design) if design.levitation is None else controlled_text(design, design.levitation)
    )
    lines = [*_head(design), *_rotor(design), *_bearings(design), *magnetic, *_touchdown(design)]
    return "\n".join([*lines, *_housings(design), *_requirement_examples(design)]) + "\n"


def _head(d: Design) -> Iterator[str]:
    amb, first = d.magnetic[0].component, d.touchdown[0].component
    yield from (
        "# Your machine, to be run with `touchdown run` and this folder.",
        "# Each value stands once. The rule that it is from stands beside it: put your own value there.",
        f"title = {_quoted(f'{d.title} dropped at {RPM * d.speed:g} rpm')}",
        *(
            controlled_head(d, d.levitation)
            if d.levitation
            else [f'zero = "{amb}.shutdown_time"  # times count from here']
        ),
    )
    if d.inclination:
        up = "of the +z end over the horizontal; 90 deg: upright"
        yield f'inclination = "{math.degrees(d.inclination):g} deg"  # {up}'
    yield from (
        f'energy_scale = ["rotor.mass", "{first}.gravity", "{first}.clearance"]',
        "attach = [  # a bearing's port, and where on the rotor or in which housing it sits",
    )
    yield from (f'    ["{s.component}.journal", "rotor.{s.station}"],' for s in d.magnetic)
    for s in d.touchdown:
        yield f'    ["{s.component}.journal", "rotor.{s.station}"],'
        yield f'    ["{s.component}.housing", "{_housing(s.component)}.seat"],'
    yield from (
        "]",
        *(controlled_events(d) if d.levitation else ()),
        "",
        "[run]",
        *(RUN_ON if d.levitation else RUN),
        'macro_step = "20 us"  # `touchdown compare --of steps` advises one for peaks within 1 %',
    )


def _rotor(d: Design) -> Iterator[str]:
    yield from ("", "# -- the rotor", "", "[components.rotor]", f'fmu = "{d.rotor}"')
    yield "[components.rotor.set]"
    if d.inertia is not None:
        yield f'mass = "{d.mass:g} kg"'
        yield f'inertia = "{d.inertia:.3g} kg.m2"  # polar; by default mass times journal radius squared'
    elif d.modes is not None:
        yield f"modes = {d.modes.modes}  # per plane, the two rigid ones included; 0: all; {d.modes}"
    yield f'speed = "{RPM * d.speed:g} rpm"  # by default {_speed_rule(d)}'
    if d.axial:
        yield "axial = 1  # it moves along its shaft; axial_load, thrust: of the process"


def _speed_rule(d: Design) -> str:
    """How fast `sensible_speed` has a machine turn."""
    bore = f"{MAX_BORE_SPEED * MM:,.0f} mm rpm over the bore"
    if d.bending is None:
        return bore
    return f"{MAX_SPEED_RATIO:g} of the first bending frequency, {d.bending:.4g} Hz, and at most {bore}"


def _bearings(d: Design) -> Iterator[str]:
    """The components themselves, and of the touchdown bearings what is not the same in all."""
    for s in d.magnetic:
        yield from (
            "",
            f"[components.{s.component}]",
            f'fmu = "{"amb_actuator" if d.levitation else "amb"}"  # {d.carries} {s.load:.4g} N at rest',
        )
        if d.levitation:
            yield from ("", f"[components.{controller(s)}]", 'fmu = "amb_controller"')
        elif d.axial and s == d.magnetic[0]:
            yield from _magnetic_along(d)
    for s, bearing, preset in zip(d.touchdown, d.bearings, d.presets, strict=True):
        yield from (
            "",
            f"[components.{s.component}]",
            f'fmu = "{_family(d, s, bearing)}"  # {d.carries} {s.load:.4g} N once the rotor is down',
        )
        if not _alike(d):
            yield f"preset = {_quoted(preset)}"
        if s.component == d.axial or not _alike(d):
            yield f"[components.{s.component}.set]"
        if s.component == d.axial:
            yield from _faces(d, bearing)
        if not _alike(d):
            yield from _fitted(bearing, d.clearance, abs(s.load))
            yield from _growing(_family(d, s, bearing), bearing, d.speed, abs(s.load))
    for s, bearing in zip(d.touchdown, d.bearings, strict=True):
        yield from ("", f"[components.{_housing(s.component)}]", f'fmu = "{model(d.mount)}"')
        if not _alike(d):
            yield from (f"[components.{_housing(s.component)}.set]", _outer_ring(bearing))


def _magnetic_along(d: Design) -> Iterator[str]:
    """The axial magnetic bearing, in the first of the radial ones."""
    stiffness, damping, force = _levitation(d.mass)
    yield from (
        f"[components.{d.magnetic[0].component}.set]",
        f'axial = {{ stiffness = {stiffness_text(stiffness)}, damping = "{damping:g} N.s/m", '
        f'force_limit = "{force:g} N" }}  # the axial one, here: of the whole rotor by the rules below',
    )


def _levitation(mass: float) -> tuple[float, float, float]:
    """Stiffness (N/m), damping (N s/m) and largest force (N) of a magnetic bearing for a mass (kg)."""
    damping = 2.0 * LEVITATION_DAMPING * mass * LEVITATION_FREQUENCY
    force = FORCE_LIMIT_RATIO * mass * GRAVITY
    return rounded(mass * LEVITATION_FREQUENCY**2), rounded(damping), rounded(force)


def _faces(d: Design, bearing: Bearing) -> Iterator[str]:
    """The faces on which the rotor's shoulders land, a fall of gravity away."""
    fall = math.sqrt(2.0 * GRAVITY * d.clearance)
    kept = 1.0 - STEEL_LOSS / 1.5 * fall
    gap = f"{d.clearance * MM:g} mm"
    if bearing.arrangement == TANDEM:
        arrangement, side = ("tandem reversed", "-z") if d.inclination > 0.0 else ("tandem", "+z")
        yield f'arrangement = "{arrangement}"  # carries a shaft pushed in {side} only: by weight or thrust'
    yield from (
        f'shoulder.gap_minus = "{gap}"  # way towards -z to the face; by default the clearance',
        f'shoulder.gap_plus = "{gap}"  # towards +z',
        f"shoulder.dissipation = {STEEL_LOSS:g}  # s/m, as below: of the {fall:.2g} m/s of a fall "
        f"through that gap {kept:.4g} come back; ring, balls and mount take more",
    )


def _magnetic(d: Design) -> Iterator[str]:
    mass = d.levitated_mass
    stiffness, damping, force = _levitation(mass)
    yield from (
        "",
        f"# -- the magnetic bearings: a mass of {mass:.4g} kg on the one that has most",
        "",
        heading([s.component for s in d.magnetic]),
        'shutdown_time = "20 ms"',
        f"stiffness = {stiffness_text(stiffness)}  # that mass swings with "
        f"{LEVITATION_FREQUENCY / HERTZ:.3g} Hz",
        f'damping = "{damping:g} N.s/m"  # {LEVITATION_DAMPING:g} of critical',
        f'force_limit = "{force:g} N"  # {FORCE_LIMIT_RATIO:g} times what it carries at rest',
        'bandwidth = "12566 rad/s"  # of the amplifier: 2 kHz',
    )


def _touchdown(d: Design) -> Iterator[str]:
    yield from ("", "# -- the touchdown bearings", "", heading([s.component for s in d.touchdown]))
    if _alike(d):
        yield f"preset = {_quoted(d.presets[0])}  # `touchdown catalogue` lists its numbers, and others"
    yield f'clearance = "{d.clearance * MM:g} mm"  # radial; by default half an air gap of 0.5 mm'
    if _alike(d):
        yield from _fitted(d.bearings[0], d.clearance, d.landed_mass * GRAVITY)
        families = {_family(d, s, d.bearings[0]) for s in d.touchdown}
        family = families.pop() if len(families) == 1 else ""
        yield from _growing(family, d.bearings[0], d.speed, d.landed_mass * GRAVITY)
    if len(materials := {BALL_MATERIALS[bearing.balls.material] for bearing in d.bearings}) == 1:
        ceramic = f"{' or '.join(BALL_MATERIALS)}, the ceramic of hybrid bearings"
        yield f'balls.material = "{materials.pop()}"  # {ceramic}'
    yield from (
        'contact.law = "line"  # steel journal in steel bore, from geometry; or "power"',
        "contact.damping = 0",
        f"contact.dissipation = {STEEL_LOSS:g}  # s/m, what a hit loses: steel on steel",
        f"balls.dissipation = {STEEL_LOSS:g}  # s/m, balls on races, tames rare large loads; 0: none. "
        "Restitution of steel is 1 - 0.08 s/m times the speed (Hunt and Crossley 1975)",
        "friction = { kind = 0, dynamic = 0.15 }  # lubricated or coated; clean, dry steel: 0.3 to 0.6",
    )


def _housings(d: Design) -> Iterator[str]:
    names = [_housing(s.component) for s in d.touchdown]
    yield from ("", "# -- what holds the touchdown bearings", "", *holding(d, names, d.mount))
    has_ring = isinstance(d.mount, MountFile) and "outer_ring" in d.mount.settings
    if _alike(d):
        yield from () if has_ring else (_outer_ring(d.bearings[0]),)
        yield _loose(d.bearings[0], d.clearance, d.landed_mass * GRAVITY)


def _requirement_examples(d: Design) -> Iterator[str]:
    """All requirements, as comments: only the machine's designer knows the numbers."""
    seat = d.touchdown[0]
    pressure = f"{1e-9 * d.bearings[0].rated().pressure_limit:g} GPa"  # dents a race by 0.0001 of a ball
    yield from (
        "",
        "# -- what the drop has to meet: the report says pass or fail, `touchdown rank` ranks by it",
        "",
        '# [requirements]  # a limit, or { limit = LIMIT, clause = "customer spec 4.2" }',
        "# of one gap or bearing alone: least_gap.seal, temperature.A",
    )
    for name, one in KINDS.items():
        limit = pressure if name == "ball_pressure" else one.example
        limit = limit if one.quantity.unit == "1" else _quoted(limit)
        yield f"# {name} = {limit}  # {SIDES[one.quantity.worse]}; {one.says}"
    yield from ("#", "# [document]  # the cover of its report; also customer, author and revision")
    yield f"# machine = {_quoted(d.title)}"
    yield from _gap(d, seat, "seal", "radial", "" if d.axial else "# ")
    if d.axial:
        seat = next(s for s in d.touchdown if s.component == d.axial)
        yield from _gap(d, seat, "impeller", "axial", "")


def _gap(d: Design, seat: Support, name: str, kind: str, comment: str) -> Iterator[str]:
    """A gap around the rotor at a seat, across or along the shaft, perhaps as a comment."""
    lines = (
        "",
        "[[gap]]  # what stands around the rotor; the least that is left is reported",
        f'name = "{name}"',
        f'at = "rotor.{seat.station}"',
        f'{kind} = "{1.5 * d.clearance * MM:g} mm"  # 1.5 of the way to the touchdown bearing',
        f'stator = "{_housing(seat.component)}.seat"  # what it moves with; left out: it stands still',
    )
    yield from (f"{comment}{line}".rstrip() for line in lines)


def _loose(bearing: Bearing, clearance: float, weight: float) -> str:
    """A comment on a loose seat, which drops leave out."""
    load = landing(bearing, clearance, weight * clearance).load
    top = harmonics_for(bearing.balls.count)
    held, loose = (float(ball_loads(bearing, load, top, seat=seat).max()) for seat in (HELD, LOOSE_SEAT))
    return (
        f"# it is held round here; loose by {UM * LOOSE_SEAT.play:g} um (radial) in its seat it would add "
        f"{percent(loose / held - 1.0)} to the most loaded ball's load"
    )


def _fitted(bearing: Bearing, clearance: float, weight: float) -> Iterator[str]:
    """Settings that depend on the bearing's size, and on the weight (N) that falls on it."""
    radius, hit = 0.5 * bearing.bore - clearance, landing(bearing, clearance, weight * clearance)
    yield f'journal_radius = "{radius * MM:g} mm"  # half the bore less the clearance'
    why = "the most that makes a line contact" if hit.is_most else "what the fall presses it with"
    load = rounded(hit.load, down=True)
    yield f'contact.load = "{load:g} N"  # at which the line contact is matched: {why}'
    indentation = f"{rounded(UM * hit.indentation):g} um"
    yield f'balls.expected_indentation = "{indentation}"  # of the most loaded ball, then'
    yield _bending(bearing, hit.load)
    drag, law = rounded(rolling_resistance(bearing)), f"M = {COEFFICIENTS[kind(bearing)]:g} P d/2"
    comment = f"the balls' drag, which sustains a whirl; 0: none. SKF: {law}, {kind(bearing)}, lubricated"
    yield f"rolling.resistance = {drag:g}  # {comment}"
    yield "rolling.f1 = 0  # of Harris's moment, which that one stands for"
    if bearing.damping == 0.0:
        comment = "between the rings, as of a 6014: catalogues do not state it"
        yield f'damping = "{RING_DAMPING:g} N.s/m"  # {comment}'


def _bending(bearing: Bearing, load: float) -> str:
    """Whether the inner ring bends under the landing's load (N)."""
    harmonics, gain = harmonics_worth(bearing, load)
    added = f"{percent(gain)} to the most loaded ball's load, from geometry"
    if bearing.angle_in_drops > 0.0:
        why = "a ring with a contact angle also twists, which is left out"
        return f"ring.harmonics = 0  # rigid: {why}; -1: bending in its plane, which would add {added}"
    if harmonics == 0:
        return f"ring.harmonics = 0  # a rigid inner ring: its bending would add {added}"
    return f"ring.harmonics = {harmonics}  # the inner ring bends, as many as matter: it adds {added}"


def _growing(family: str, bearing: Bearing, speed: float, weight: float) -> Iterator[str]:
    """What the rotor's `speed` (rad/s) does to the rings, where it matters; weight: N on the bearing."""
    fast = spun(bearing, speed, weight)
    if fast.matters:
        yield f"ring.growth = 1  # by spin: at the rotor's speed {fast.words()}"
    if fast.matters and family == IN_SPACE:
        yield "ring.hoop = 1  # and both rings give under the balls; outer_ring.seat: how one sits"
        yield "balls.centrifugal = 1  # and its orbit throws a ball outwards"


def _family(d: Design, seat: Support, bearing: Bearing) -> str:
    """The model of a bearing: planar, or in space where it has faces or its rows have a contact angle."""
    in_space = bearing.angle_in_drops > 0.0 or seat.component == d.axial
    return IN_SPACE if in_space else "simplified_caged"


def _outer_ring(bearing: Bearing) -> str:
    return f'outer_ring = "{bearing.outer_ring:.3g} kg"  # of the {bearing.designation}'


def _quoted(text: str) -> str:
    """Text as TOML has it."""
    return json.dumps(text, ensure_ascii=False)


def _alike(d: Design) -> bool:
    """Whether all touchdown bearings are the same."""
    return len(set(d.presets)) == 1


def _housing(bearing: str) -> str:
    """The name of the housing of a touchdown bearing."""
    return bearing.replace("bearing", "housing", 1)
