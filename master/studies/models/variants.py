"""What could be left out of a scene, or put in: variants by what its components have, not by its name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from touchdown.master.coupling.simulation import opened
from touchdown.master.coupling.system import System
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.master.studies.drop.measured import finest_inside
from touchdown.master.studies.modes.compare import BASIS, RIGID

MODES = (3, 10, 20)  # per plane, beside the scene's own number and the rigid rotor
OTHER = {
    "detailed_caged": ("simplified_caged", "simplified bearings"),
    "detailed_cageless": ("simplified_cageless", "simplified bearings"),
    "simplified_caged": ("detailed_caged", "detailed bearings"),
    "simplified_cageless": ("detailed_cageless", "detailed bearings"),
}
PLAIN = "bushing"
COULOMB = 0  # of friction.kind
STEPPING = ("interface.", "micro_step")
LOOSER = 100.0  # times the tolerance inside a bearing
OFFSETS = ("x0", "y0")  # of a housing out of line


@dataclass(frozen=True)
class Variant:
    """A scene that differs in one thing."""

    title: str
    scene: Scene
    recorded: bool = True


def variants(scene: Scene) -> list[Variant]:
    """All that apply, the coupling first."""
    with opened(scene, in_process=True) as system:
        seats = dict.fromkeys(a.bearing for a in touchdown_seats(system))
        return [
            *_coupling(scene, system),
            *_rotors(scene, system),
            *_bearings(scene, system, list(seats)),
            *_friction(scene, system, list(seats)),
            *_inner_steps(scene, system, list(seats)),
            *_housings(scene, system),
            Variant("nothing recorded", scene, recorded=False),
        ]


def _coupling(scene: Scene, system: System) -> Iterator[Variant]:
    """How much of every difference is the coupling's: half the macro step tells."""
    step = scene.run.macro_step
    for factor in (0.5, 2.0):
        run = scene.set({"run.macro_step": factor * step})
        yield Variant(f"macro step of {1e6 * factor * step:g} us", run)
    if scene.run.scheme.modes and _flexible(system):
        run = scene.set({"run.scheme": "point-mass"})
        yield Variant("rotor's modes not carried (point-mass)", run)


def _flexible(system: System) -> list[str]:
    return [n for n, c in system.components.items() if all(v in c.variables for v in BASIS)]


def _rotors(scene: Scene, system: System) -> Iterator[Variant]:
    rotors = _flexible(system)
    if not rotors:
        return
    modes = {system.value(f"{name}.modes") for name in rotors}
    yield Variant("rigid rotor", _all(scene, rotors, {"modes": RIGID, "residual": 0}))
    for count in MODES:
        if modes != {count}:
            yield Variant(f"{count} modes", _all(scene, rotors, {"modes": count}))
    if any(system.value(f"{name}.residual") for name in rotors):
        yield Variant("no residual flexibility", _all(scene, rotors, {"residual": 0}))
    else:
        yield Variant("with residual flexibility", _all(scene, rotors, {"residual": 1}))
    if any(system.value(f"{name}.stress.active") for name in rotors):
        yield Variant("no stresses", _all(scene, rotors, {"stress.active": 0}))


def _all(scene: Scene, names: Sequence[str], values: Mapping[str, object]) -> Scene:
    return scene.set({f"{name}.{key}": value for name in names for key, value in values.items()})


def _bearings(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    known = {name: OTHER[fmu] for name in seats if (fmu := scene.components[name].fmu) in OTHER}
    if known:
        title = " and ".join(dict.fromkeys(title for _, title in known.values()))
        yield Variant(title, _swapped(scene, system, {name: fmu for name, (fmu, _) in known.items()}))
        yield Variant("plain bushings", _swapped(scene, system, dict.fromkeys(known, PLAIN)))


def _swapped(scene: Scene, system: System, fmus: Mapping[str, str]) -> Scene:
    """With all parameters of the present ones that the others have too, but for those of their steps."""
    components = dict(scene.components)
    for name, fmu in fmus.items():
        variables = system.components[name].variables.values()
        parameters = [v.name for v in variables if v.causality == "parameter" and v.settable]
        values = {v: system.value(f"{name}.{v}") for v in parameters if not v.startswith(STEPPING)}
        components[name] = ComponentSpec(fmu, preset=components[name].preset, inherited=values)
    return replace(scene, components=components)


def _friction(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    """Other laws between journal and ring, with the scene's coefficients."""
    has = [name for name in seats if "friction.kind" in system.components[name].variables]
    if not has:
        return
    kind = system.components[has[0]].variable("friction.kind")
    present = {system.value(f"{name}.friction.kind") for name in has}
    for value in range(int(kind.minimum or 0), int(kind.maximum or 0) + 1):
        if present != {value}:
            yield Variant(f"friction: {kind.told(value)}", _with_law(scene, system, has, value))


def _with_law(scene: Scene, system: System, seats: Sequence[str], kind: int) -> Scene:
    """Scene with that friction law; Coulomb's has one coefficient only, the dynamic one."""
    for name in seats:
        changes: dict[str, object] = {f"{name}.friction.kind": kind}
        if kind == COULOMB:
            changes[f"{name}.friction.static"] = system.value(f"{name}.friction.dynamic")
        scene = scene.set(changes)
    return scene


def _inner_steps(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    """Longer steps inside bearings of fixed ones, a looser tolerance in those that adapt theirs; and the
    finest in all, which tell how far the scene's own are off.
    """
    fixed = [n for n in seats if "micro_step" in system.components[n].variables]
    fixed = [n for n in fixed if system.value(f"{n}.micro_step") > 0.0]
    if fixed:
        values = {f"{name}.micro_step": 2.0 * system.value(f"{name}.micro_step") for name in fixed}
        yield Variant("steps inside bearings twice as long", scene.set(values))
    variable = "interface.tolerance"
    rest = [n for n in seats if n not in fixed and variable in system.components[n].variables]
    if rest:
        values = {f"{name}.{variable}": LOOSER * system.value(f"{name}.{variable}") for name in rest}
        title = f"tolerance inside bearings {LOOSER:g} times as large"
        yield Variant(title, scene.set(values))
    if fixed or rest:
        yield Variant("fine adaptive steps inside bearings", scene.set(finest_inside(system)))


def _housings(scene: Scene, system: System) -> Iterator[Variant]:
    """Outer rings that stand in the ground, where no housing is out of line."""
    seats = touchdown_seats(system)
    bearings = {a.bearing for a in seats}
    mounts = [a for a in system.attachments if a.bearing in bearings and a not in seats]
    names = {a.body for a in mounts} - {a.body for a in seats}
    offsets = [f"{n}.{v}" for n in names for v in OFFSETS if v in system.components[n].variables]
    if not names or any(system.value(offset) for offset in offsets) or names & tied(scene):
        return
    yield Variant(
        "housings that stand still",
        replace(
            scene,
            components={n: c for n, c in scene.components.items() if n not in names},
            attach=tuple(pair for pair in scene.attach if pair[1].partition(".")[0] not in names),
        ),
    )


def tied(scene: Scene) -> set[str]:
    """Components that others hang on by sensors, single connections or bonds, beside bearings' ports."""
    wires = (*scene.connect, *(wire for bond in scene.bond for wire in bond.wires))
    pairs = (*scene.sense, *((wire.source, wire.target) for wire in wires))
    return {end.partition(".")[0] for pair in pairs for end in pair}
