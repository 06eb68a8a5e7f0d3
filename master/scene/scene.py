"""A scene: components, how they are attached, and how to run them."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path, PurePath
from typing import Any, NamedTuple, cast

from ...modelkit.errors import require
from ...modelkit.reader import FLAG, LIST, TEXT, Kind, Table, key, kinds, listed, number
from ..common import text
from ..common.errors import TouchdownError, one_of
from ..common.units import Scale, plain, to_si
from .gaps import RotorGap
from .requirements import Requirement
from .run_spec import STEPS, UNITS, RunSpec, with_changes
from .schemes import Scheme
from .tables import COMPONENTS, NAMED, PORTS, ZERO, is_table, naming


class Wire(NamedTuple):
    """A single variable feeding another, COMPONENT.VARIABLE both."""

    source: str
    target: str
    scale: Scale | None = None  # factor and offset; None: unchanged, in equal units


class BondSpec(NamedTuple):
    """A force one way and a motion the other, whose product is power.

    What a file gives as a list says by its units, or else by its order, which motion is which.
    """

    force: Wire
    position: Wire | None = None
    velocity: Wire | None = None
    motion: tuple[Wire, ...] = ()  # not told apart yet

    @property
    def wires(self) -> tuple[Wire, ...]:
        """All of them, the force first."""
        declared = (self.force, self.position, self.velocity)
        return (*(wire for wire in declared if wire is not None), *self.motion)


def _wire(value: Any, name: str) -> Wire:
    """Source and target, and where it is scaled, factor and offset."""
    source, target = PORTS.read(LIST.take(value, name)[:2], name)
    if len(value) == 2:
        return Wire(source, target)
    factor, offset = value[2:]
    what = f"{name}: {source} to {target}"
    return Wire(
        source, target, (to_si(factor, "1", f"{what}, factor"), to_si(offset, None, f"{what}, offset"))
    )


WIRE = Kind(_wire, 'source and target, such as ["rotor.A.x", "probe.x"]; then, if any, factor and offset')


@dataclass(frozen=True)
class _Bond:
    """A bond as a table."""

    force: Wire = key(WIRE)
    position: Wire | None = key(WIRE, None)
    velocity: Wire | None = key(WIRE, None)


def _bond(value: Any, name: str) -> BondSpec:
    """A bond as a table, or as a list of its wires, the force first."""
    if is_table(value):
        found = Table(f"{name}.", value).read(_Bond)
        bond = BondSpec(found.force, found.position, found.velocity)
    else:
        force, *motion = (WIRE.read(wire, name) for wire in LIST.take(value, name))
        bond = BondSpec(force, motion=tuple(motion))
    if not 2 <= len(bond.wires) <= 3:
        raise ValueError
    return bond


BOND = Kind(
    _bond,
    "a force and one or two wires of motion, "
    'such as [["s1.f", "s2.f"], ["s2.x", "s1.x2"], ["s2.v", "s1.v2"]], or a table of them',
)


def _bonds(value: Any, name: str) -> tuple[BondSpec, ...]:
    """A single bond as a list of its wires; or a list of bonds, of which each may be a table."""
    wires = LIST.take(value, name)
    single = bool(wires) and all(isinstance(one, list) and isinstance(one[0], str) for one in wires if one)
    return tuple(BOND.read(one, name) for one in ([wires] if single else wires))


UPRIGHT = 0.5 * math.pi + 1e-9  # rad, the most that a shaft is inclined, with rounding
# of the machine: rad, of +z over the horizontal
INCLINED = number("rad", minimum=-UPRIGHT, maximum=UPRIGHT, example="90 deg")
INCLINATION = "inclination"  # of the machine, and of each component that has weight
MAX_TITLE_CHANGES = 3  # changes that a title names
_DIGEST = re.compile(r"_[0-9a-f]{16}$")  # of a rotor made in Python


def retitled(title: str, component: str, before: str, after: str, alone: bool) -> str:
    """A scene's title once `component` is the FMU `after` in place of `before`.

    Where the title names `before`, and that is the only component of its kind (`alone`), it names `after`
    instead; else what was swapped is added.

    >>> retitled("A disk on a simplified caged bearing", "bearing", "simplified_caged", "bushing", True)
    'A disk on a bushing bearing'
    >>> retitled("Two bearings", "bearing_A", "amb", "my/own.fmu", False)
    'Two bearings (bearing_A: own)'
    """
    old, new = _words(before), _words(after)
    if old == new:
        return title
    added = f" ({component}: {{}})"
    if added.format(old) in title:
        return title.replace(added.format(old), added.format(new))
    found = re.search(rf"\b{re.escape(old)}\b", title, re.IGNORECASE) if alone else None
    if found is None:
        return title + added.format(new)
    capital = found[0][0].isupper() and not old[0].isupper()
    return title[: found.start()] + (new[0].upper() + new[1:] if capital else new) + title[found.end() :]


def amended(title: str, changes: Sequence[str]) -> str:
    """A scene's title with what was set beside the scene, which the title may deny.

    >>> amended("A disk at 9000 rpm", ["rotor.speed = 12000 rpm"])
    'A disk at 9000 rpm, but with rotor.speed = 12000 rpm'
    """
    return f"{title}, but with {text.joined(changes, most=MAX_TITLE_CHANGES)}" if changes else title


def _words(fmu: str) -> str:
    """The name of an FMU, for people: that of its file without underscores."""
    return _DIGEST.sub("", PurePath(fmu).stem).replace("_", " ")


LAW, LAWS = "law", (".json", ".npz", ".mat")  # of a controller: a setting, and what its files end with
COMPONENT_KEYS = ("every", "sampled", "isolate", "native")  # of a component, not variables of it


@dataclass(frozen=True)
class ComponentSpec:
    """A component: where it comes from and what is set in it."""

    fmu: str = key(
        Kind(TEXT.take, "the name of an FMU, or the path of an .fmu"), says="where the component comes from"
    )
    set: Mapping[str, object] = field(default_factory=dict[str, object])
    preset: str | None = None  # a named set of parameters, applied first
    every: int = key(STEPS, 1, "macro steps of the run that it takes in one")
    names: Mapping[str, str] = field(default_factory=dict[str, str])
    """Variables of the contract, and what this FMU calls them."""
    inherited: Mapping[str, object] = field(default_factory=dict[str, object])
    """The scene's settings for what it was swapped for; those it can take are applied before `set`."""
    isolate: bool = key(FLAG, True, "step a third-party FMU in a process of its own, supervised")
    native: bool = key(FLAG, False, "one of the project's own: take its FMU that needs no Python")
    instead_of: str = ""  # what it was swapped for
    own: tuple[str, ...] = ()  # of `set` and `preset`: set by the user beside the scene, to stay in a swap
    sampled: float = key(  # 0: `every` counts
        number("s", above=0.0), 0.0, "a controller's: from one sample to the next, at any macro step"
    )

    @property
    def set_beside(self) -> dict[str, object]:
        """The settings of the user beside the scene, by name."""
        return {name: self.preset if name == "preset" else self.set[name] for name in self.own}

    def step(self, macro_step: float) -> float:
        """How long its own steps are (s), where the run's are `macro_step` (s)."""
        return self.sampled or self.every * macro_step

    def swapped(self, fmu: str) -> ComponentSpec:
        """The component with another FMU in its place."""
        theirs = {name: value for name, value in self.set.items() if name not in self.own}
        by_name = not Path(
            fmu
        ).suffix  # the project's own model: a file may mean other things by these names
        return ComponentSpec(
            fmu,
            set={name: value for name, value in self.set.items() if name in self.own},
            preset=self.preset if by_name or "preset" in self.own else None,
            every=self.every,
            sampled=self.sampled,
            isolate=self.isolate,
            native=self.native,
            inherited={**self.inherited, **theirs},
            instead_of=self.instead_of or self.fmu,
            own=self.own,
        )


@dataclass(frozen=True)
class Document:
    """What the cover of a report says of machine and people."""

    machine: str = key(TEXT, "", "its name and number")
    customer: str = key(TEXT, "", "for whom it is")
    author: str = key(TEXT, "", "who answers for it")
    revision: str = key(TEXT, "", "of the report, such as B of 2026-03-02")


@dataclass(frozen=True, repr=False)
class Scene:
    """Everything a run needs. `set` and `swap` make copies, which share what they do not change.

    Its tables, such as `components`, are to be read: what is written into them is not checked.

    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene.set({"rotor.speed": "12000 rpm", "run.duration": "10 ms"}).swap(bearing="simplified_cageless")
    <Scene disk-caged-simplified: Rigid disk dropped on a simplified cageless bearing
      rotor: rigid_rotor
      amb: amb
      bearing: simplified_cageless (6004)
      housing: housing
      run: 0.01 s by macro steps of 0.0001 s, scheme interface>
    """

    name: str
    title: str
    components: Mapping[str, ComponentSpec]
    about: str = key(TEXT, "", "for readers")
    attach: tuple[tuple[str, str], ...] = key(listed(PORTS), (), "a bearing's port and a body's")
    sense: tuple[tuple[str, str], ...] = key(
        listed(PORTS), (), "motion of a body's port only, the sensor first"
    )
    control: tuple[tuple[str, str], ...] = key(
        listed(COMPONENTS), (), "a controller and its actuator; the first of two has its first axes"
    )
    connect: tuple[Wire, ...] = key(
        listed(WIRE), (), "single variables, also integers, Booleans and choices, which are not scaled"
    )
    bond: tuple[BondSpec, ...] = key(
        Kind(_bonds, f"a list of bonds, each {BOND.meant}"), (), "a force and the motion that it acts along"
    )
    zero: str | None = key(ZERO, None, "times and the duration count from here")
    energy_scale: tuple[str, ...] = key(
        listed(naming(example="rotor.mass")),
        (),
        "the product is the energy that errors are held against",
    )
    run: RunSpec = field(default_factory=RunSpec)
    folder: Path = Path()  # relative paths of FMUs start here
    gaps: tuple[RotorGap, ...] = ()  # around the rotor, to be watched
    requirements: tuple[Requirement, ...] = ()  # what the drop is to keep to
    document: Document = Document()
    own: tuple[str, ...] = ()  # keys of `run` that the user set beside the scene
    remarks: tuple[str, ...] = ()  # what is to be said of its file, a line each
    inclination: float | None = key(
        INCLINED, None, "of the shaft's +z end over the horizontal; else as each component has it"
    )

    def __post_init__(self) -> None:
        """Raise TouchdownError for a component's name that no recording or package can have."""
        for component in self.components:
            NAMED.read(component, f"scene {self.name}: the name of a component")

    @property
    def bushings(self) -> frozenset[str]:
        """The components that gaps are which act."""
        return frozenset(gap.key for gap in self.gaps if gap.acts)

    def set(self, settings: Mapping[str, object]) -> Scene:
        """A copy with each COMPONENT.VARIABLE or run.KEY set to its value, in their order.

        Numbers are SI; text may carry a unit, such as "9000 rpm". COMPONENT.preset names a bearing of the
        catalogue or of a file (FILE.toml:NAME, from the scene's folder or the current one), COMPONENT.every
        how many macro steps a component takes in one, COMPONENT.sampled how long its steps are,
        COMPONENT.isolate whether a third-party FMU is stepped in a process of its own, COMPONENT.native
        whether one of the project's own is taken as its native FMU, COMPONENT.law a controller's file in
        its place (from the scene's folder or the current one). A COMPONENT with * or ? is all whose
        names match: "bearing_*.friction.dynamic". `inclination` is that of the whole machine. Raises
        TouchdownError where there is no such component, key or preset; a component's variables are looked
        up when a run begins.
        """
        scene = self
        for name, value in settings.items():
            for setting in self.matching_settings(name):
                scene = scene._with_setting(setting, value)
        return scene

    def matching_settings(self, name: str) -> list[str]:
        """The settings that COMPONENT.VARIABLE means, of all components that match.

        Raises TouchdownError where none matches.
        """
        head, dot, tail = name.partition(".")
        return [f"{component}{dot}{tail}" for component in self.matching(head)]

    def matching(self, pattern: str) -> list[str]:
        """Components whose names match a `pattern` with * or ?; a name without them stands for itself.

        Raises TouchdownError where none matches.
        """
        if not any(sign in pattern for sign in "*?"):
            return [pattern]
        found = [name for name in self.components if fnmatchcase(name, pattern)]
        if not found:
            known = ", ".join(self.components)
            raise TouchdownError(f"no component of scene {self.name} matches {pattern}; there are: {known}")
        return found

    def _with_setting(self, name: str, value: object) -> Scene:
        head, _, tail = name.partition(".")
        if name == INCLINATION:
            return replace(self, inclination=INCLINED.read(value, f"scene {self.name}: {INCLINATION}"))
        require(tail, f"cannot set {name}; write COMPONENT.VARIABLE, run.KEY or {INCLINATION}")
        if head == "run":
            return replace(self, run=with_changes(self.run, {tail: value}), own=_with(self.own, tail))
        spec, known = self._component(head), kinds(ComponentSpec)
        if tail == LAW and str(value).lower().endswith(LAWS):
            there = self.folder / str(value)
            return self.swap(**{head: there if there.is_file() else str(value)})
        if tail == "preset":
            preset = checked_preset(value, head, self.folder, Path())
            changed = replace(spec, preset=preset, own=_with(spec.own, tail))
        elif tail in COMPONENT_KEYS:
            steps = {"every": 1, "sampled": 0.0} if tail in ("every", "sampled") else {}
            changed = replace(spec, **steps | {tail: known[tail].read(value, name)})
        else:
            changed = replace(spec, set={**spec.set, tail: plain(value)}, own=_with(spec.own, tail))
        return replace(self, components={**self.components, head: changed})

    def swap(self, /, **fmus: str | os.PathLike[str]) -> Scene:
        """A copy with components made of other FMUs: swap(bearing="detailed_caged").

        An FMU is one of the project's by name, or the path of an .fmu, of a rotor's .toml or of a
        controller's file (docs/levitation.md), or a Rotor; paths start in the current directory. It starts
        from its own defaults and takes over what the scene sets, as far as it can; a run says what it could
        not. A model of the project takes over the preset, too: it is of the same bearing. What `set` gave
        stays, and it must have it. Names that the scene gives belong to the FMU that goes; `with_names`
        gives the new one's. The title names the new one. Raises TouchdownError where there is no such
        component.
        """
        scene = self
        for name, fmu in fmus.items():
            before = scene._component(name)
            after = before.swapped(_source(os.fspath(fmu)))
            others = [spec.fmu for other, spec in scene.components.items() if other != name]
            title = retitled(scene.title, name, before.fmu, after.fmu, before.fmu not in others)
            scene = replace(scene, title=title, components={**scene.components, name: after})
        return scene

    def with_names(self, name: str, names: Mapping[str, str]) -> Scene:
        """A copy in which the FMU of component `name` calls the contract's variables as `names` says."""
        spec = replace(self._component(name), names=names)
        return replace(self, components={**self.components, name: spec})

    def __repr__(self) -> str:
        components = [
            f"  {name}: {spec.fmu}{f' ({spec.preset})' if spec.preset else ''}"
            for name, spec in self.components.items()
        ]
        run = f"{self.run.duration:g} s by macro steps of {self.run.macro_step:g} s"
        lines = [
            f"<Scene {self.name}: {self.title}",
            *components,
            f"  run: {run}, scheme {self.run.scheme.name}>",
        ]
        return "\n".join(lines)

    def _component(self, name: str) -> ComponentSpec:
        try:
            return self.components[name]
        except KeyError:
            raise TouchdownError(
                f"scene {self.name} has no component {name}; {one_of(name, [*self.components, 'run'])}"
            ) from None

    def changes(self, unit_of: Callable[[str, str], str | None]) -> list[str]:
        """The settings of the user in components beside the scene, for people.

        unit_of(component, variable): its SI unit.
        """
        return [
            f"{name}.{key} = {text.as_given(value, unit_of(name, key) if key in spec.set else None, key)}"
            for name, spec in self.components.items()
            for key, value in spec.set_beside.items()
        ]

    def run_changes(self) -> list[str]:
        """The settings of the user in [run] beside the scene, for people."""
        changed = {key: getattr(self.run, key) for key in self.own}
        return [f"run.{k} = {text.as_given(_as_written(v), UNITS.get(k))}" for k, v in changed.items()]

    def resolved(self) -> dict[str, object]:
        """All of it as plain values, for JSON."""
        values = asdict(self)
        values["run"]["scheme"] = self.run.scheme.name
        del values["remarks"]  # of the file, which a run leaves behind
        return values


def _with(names: tuple[str, ...], name: str) -> tuple[str, ...]:
    return names if name in names else (*names, name)


def _as_written(value: object) -> object:
    """A value of [run] as its file has it."""
    if isinstance(value, Scheme):
        return value.name
    return ", ".join(cast(tuple[str, ...], value)) if isinstance(value, tuple) else value


def is_file(fmu: str) -> bool:
    """Whether what a component is made of is named by a path, not one of the project's own by its name."""
    return fmu.lower().endswith((".fmu", ".toml", *LAWS)) or os.sep in fmu


def _source(fmu: str) -> str:
    """Where an FMU comes from, told from wherever a scene lies: files of the user's by their whole path."""
    return str(Path(fmu).expanduser().absolute()) if is_file(fmu) else fmu


def checked_preset(name: object, where: str, *folders: Path) -> str | None:
    """A bearing of the catalogue, or of a file that one of `folders` has or that is named from it; or None.

    Raises TouchdownError where there is none of that name.
    """
    if name is None:
        return None
    # imports numba, which a list of scenes can do without
    from ...fmus.recipes import find_preset

    try:
        return find_preset(str(name), *folders)
    except TouchdownError as error:
        raise TouchdownError(f"{where}: {error}") from None
