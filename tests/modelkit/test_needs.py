"""What a setting is declared to need: without it the setting changes no bit, with it, it does."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache

import pytest

from touchdown.bearings.supports.mount import MODEL as MOUNT
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model, ModelError, Slot
from touchdown.modelkit.needs import Term, lacking, needs
from touchdown.modelkit.variables import Causality, Scalar, Variable, flatten, real

MODELS = [
    name
    for name in fmu_names()
    if needs(recipe(name).model) and name not in ("rotor_II", "compressor_rotor", "exciter")
]
OTHERS = re.compile(r"\[([2-9]|\d\d)\]|mount_[ABD]|\.[ABD]\.")  # of members that are alike, one is enough

# A journal that spins pressed into the bore, and moves along and tilted; loads on bodies. SI, by last name.
INPUTS = dict(x=5e-5, vx=0.1, vy=-0.05, z=-2e-4, vz=0.02, rx=1e-3, ry=5e-4, wx=0.1, wy=0.2)
INPUTS |= dict(omega=5.0, inv_m=0.6, inv_m_z=0.6, inv_I_t=1e3, inv_I=2e3, az_free=-2.0)
INPUTS |= dict(fx=30.0, fy=-40.0, fz=20.0, mx=0.02, my=0.03, mz=0.01, period=1e-4)
ALONG, TILT = ("z", "vz", "inv_m_z", "az_free", "fz"), ("rx", "ry", "wx", "wy", "inv_I_t", "mx", "my")
STEPS, STEP = 10, 5e-5  # s
DENT = 2e-5  # m, of the journal into the bore

# Values that meet a need, where another one than the default does, by the end of their names
MEETING: Mapping[str, float] = {
    "transverse_inertia": 1e-3,
    "eccentricity": 1e-5,
    "gap_minus": 1.98e-4,
    "contact_angle": 0.26,
    "stop.stiffness": 1e8,
    "viscosity": 0.1,
    "slide[1].force": 0.2,
    "slide[1].stiffness": 1e8,
    "branch[1].stiffness": 1e8,
    "axial.stiffness": 1e5,
    "damping_ratio": 0.1,
    "noise": 1e-6,
    "amplitude": 1e-6,
    "wear": 1e-6,
    "harmonics": 2.0,
}
# What else a setting takes to be seen in this rig, by the ends of names in the same group
BESIDE: Mapping[str, Mapping[str, float]] = {
    "balls.contact_angle": {"balls.play": 0.0, "balls.rows": 2.0, "arrangement": 1.0, "row_distance": 0.01},
    "thrust_points": {"thrust[1].force": 5.0, "thrust[2].force": 9.0, "thrust[2].time": 2e-3},
    "thrust[1].time": {"thrust[1].force": 5.0, "thrust[2].force": 9.0, "thrust[2].time": 2e-3},
    **{
        name: {"brake[1].torque": 0.1, "brake[2].torque": 0.2, "brake[2].time": 2e-3, "brake[2].speed": 9e3}
        for name in ("brake_points", "brake_over", "brake[1].time", "brake[1].speed")
    },
    "row_distance": {"land": 8e-3},  # for a ring that tilts
    "arrangement": {
        "balls.rows": 2.0,
        "balls.play": 0.0,
        "balls.contact_angle": 0.26,
        "row_distance": 0.01,
    },
    "axial.force_limit": {"axial.force_limit": 5.0},
    "stop.stiffness": {"stop.gap": 1e-9},
    "lines.ratio": {"lines.ratio": 2.0},  # of the next whole multiple
    "contact.damping_ratio": {"contact.mass": 1.0},
    "ring.width": {"ring.width": 0.012},
    "ball_contact.damping_ratio": {"balls.bunching": 1.0},  # balls that touch
    "ball_friction.kind": {"balls.bunching": 1.0},
    **{f"mode[1].{name}": {"mode[1].A.x": 1.0} for name in ("omega", "damping_ratio", "mass")},
}
UNSEEN = {  # a controller that samples nothing here; one axis, both; tables of one point; stiff rings
    *(
        f"{body}.base.course.{name}"
        for body in ("housing", "rigid_rotor", "rotor_I", "spindle_rotor")
        for name in ("points", "point[1].time", "point[1].share")
    ),
    *("amb_controller.gain.filter", "amb_controller.event[1].time", "amb_axial.inject.axis"),
    *(
        f"angular_{which}.ring.{name}"
        for which in ("caged", "cageless")
        for name in ("width", "damping_ratio")
    ),
}
QUIET_OUTPUTS = {"mount.axial.stiffness", "foundation.mount_C.axial.stiffness"}  # are stated to the bearing


class Rig:
    """Runs of a model."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.slots: dict[str, Slot] = {s.variable.name: s for s in Instance(model).slots}
        inputs = [name for name, s in self.slots.items() if s.causality is Causality.INPUT]
        self.samples = [name for name in inputs if name.endswith((".sensed", "tick"))]
        self.known: dict[object, bytes] = {}  # of runs, many of which are asked for again

    def variable(self, name: str) -> Variable:
        return self.slots[name].variable

    def run(self, settings: Mapping[str, float], off: tuple[str, ...], stated: bool) -> bytes:
        """State, and outputs where `stated`, after some steps; inputs that end like one of `off` are 0."""
        own = frozenset((n, float(x)) for n, x in settings.items() if x != self.variable(n).default)
        if (own, off, stated) not in self.known:
            self.known[own, off, stated] = self._run(settings, off, stated)
        return self.known[own, off, stated]

    def _run(self, settings: Mapping[str, float], off: tuple[str, ...], stated: bool) -> bytes:
        one = Instance(self.model)

        def put(name: str, value: float) -> None:
            slot = self.slots[name]
            real = slot.variable.spec.kind is Scalar.REAL
            one.store(slot)[slot.index] = float(value) if real else int(value)

        for name, value in settings.items():
            put(name, value)
        for name, slot in self.slots.items():
            if slot.causality is Causality.INPUT and not re.match(r"housing|sensor|.*mode\[", name):
                end = name.rpartition(".")[2]
                put(name, 0.0 if end in off else INPUTS.get(end, 0.0))
        if "clearance" in self.slots:
            put("journal.y", -settings.get("clearance", self.variable("clearance").default) - DENT)
        one.start(0.0)
        for i in range(STEPS):
            for name in self.samples:
                put(name, i if name == "tick" else 1e-5 * i * i)
            one.step(i * STEP, STEP)
        return one.memory["q"].tobytes() + (one.memory["o"].tobytes() if stated else b"")


def another(v: Variable, value: float) -> float:
    """A value of a variable beside `value`."""
    whole = v.spec.kind is Scalar.INTEGER
    tried = (value + 1, value - 1) if whole else (1.25 * value, 0.8 * value, value + 1e-3, value + 1e-6)
    return next(one for one in tried if one != value and v.problem(one) is None)


def by_end(table: Mapping[str, object], name: str) -> object:
    """The entry for what `name` ends with."""
    return next((value for end, value in table.items() if f".{name}".endswith(f".{end}")), None)


def beside(name: str) -> dict[str, float]:
    """What `BESIDE` has for `name`, of the mount that it belongs to."""
    end = next((end for end in BESIDE if f".{name}".endswith(f".{end}")), "")
    return {name.removesuffix(end) + other: value for other, value in BESIDE.get(end, {}).items()}


def met(term: Term, v: Variable) -> float:
    """A value that meets a term."""
    value = by_end(MEETING, term.name) if term.compare == "!=" else term.number + (term.compare == ">")
    return float(value if isinstance(value, float) else v.default or 1.0)


def unmet(terms: list[Term], v: Variable) -> float:
    """A value of a variable that meets none of the terms on it."""
    mine = [t for t in terms if t.name == v.name]
    tried = [v.default, *(t.number + beside for t in mine for beside in (0.0, -1.0, 1.0))]
    return next(one for one in tried if not any(t.met(one) for t in mine) and v.problem(one) is None)


def same(rig: Rig, name: str, settings: Mapping[str, float], off: tuple[str, ...] = ()) -> bool:
    """Whether two values of a setting leave the same, beside `settings`."""
    for key in (name, *settings):
        if key == name or settings[key]:
            settings = {**{n: x for n, x in beside(key).items() if n in rig.slots}, **settings}
    v = rig.variable(name)
    value = settings.get(name, v.default)
    settings, stated = {**settings, name: value}, f"{rig.model.name}.{name}" not in QUIET_OUTPUTS
    return rig.run(settings, off, stated) == rig.run({**settings, name: another(v, value)}, off, stated)


EXPENSIVE = ("detailed_caged", "detailed_cageless", "angular_caged", "angular_cageless")  # seconds each


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow) if n in EXPENSIVE else n for n in MODELS]
)
def test_a_setting_acts_where_its_needs_are_met_and_only_there(name: str) -> None:
    rig, wrong = Rig(recipe(name).model), []
    for key, stated in needs(rig.model).items():
        if OTHERS.search(key) or not stated:
            continue
        own = [t for need in stated for t in need[0] if not t.of_rotor]
        all_met = {t.name: met(t, rig.variable(t.name)) for t in own}
        if f"{name}.{key}" not in UNSEEN and same(rig, key, all_met):
            wrong.append(f"{key} does nothing with {all_met}")
        for need in stated:
            for lacks in [[t] for t in need[0]] if len(need) == 1 else [[terms[0] for terms in need]]:
                if any(t.compare == ">=" and t.number <= 1.0 and t.name == "seats" for t in lacks):
                    continue  # there is always one
                off = tuple(n for t in lacks if t.of_rotor for n in (ALONG if t.name == "axial" else TILT))
                none = {t.name: unmet(lacks, rig.variable(t.name)) for t in lacks if not t.of_rotor}
                with suppress(ModelError):  # which refuses the setting then
                    if not same(rig, key, {**all_met, **none}, off):
                        wrong.append(f"{key} acts with {none} and without inputs {off}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("name", fmu_names())
def test_what_is_needed_is_there(name: str) -> None:
    """A name that no model has is a mistake, and one that not every model has is there in some."""
    model = recipe(name).model
    for terms in (terms for stated in needs(model).values() for need in stated for terms in need):
        assert terms
        for term in terms:
            at = {"rigid_rotor", "rotor_I"} if term.of_rotor else {name}
            assert any(term.name in exposed(one) for one in at)


@cache
def exposed(name: str) -> set[str]:
    """Names of a model's parameters."""
    model = recipe(name).model
    return {model.rename(v.name) or v.name for v in flatten(model.parameters())}


@dataclass(frozen=True)
class Wrong:
    """A slip of the pen."""

    gap: float = real(0.0, "m", "gap", needs="stifness")


def test_a_need_for_what_is_not_there_is_refused() -> None:
    with pytest.raises(ValueError, match=r"mount\.gap needs stifness, which the model does not have"):
        needs(replace(MOUNT, parameters=Wrong))


def test_one_alternative_is_enough() -> None:
    need = ((Term("a"), Term("b", ">=", 2.0)), (Term("c", "==", 1.0),))
    values = {"a": 1.0, "b": 1.0, "c": 0.0}
    assert lacking(need, lambda t: [values[t.name]]) == [Term("b", ">=", 2.0), Term("c", "==", 1.0)]
    assert lacking(need, lambda t: [values[t.name], 1.0] if t.name == "c" else [0.0]) == []
    assert lacking(need, lambda t: []) == []
