"""Chapters on what the figures rest on: model, accuracy, settings, how to repeat the run."""

from __future__ import annotations

import base64
import json
import platform
import re
import shlex
from dataclasses import asdict
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any

from ...fmus.recipes import fmu_names, recipe
from ...fmus.version import VERSION
from ...master.common.errors import TouchdownError
from ...master.common.text import display_value, joined
from ...master.components.component import ScalarVariable
from ...master.coupling.connections import housing_port
from ...master.coupling.ledger.alarms import energy_share
from ...master.quantities import Quantity, summary_items
from ...master.results.ratings import Origin, setting_origin
from ...master.results.summary import energy_total
from ...master.scene.file import SCENE_FILE, shipped_scenes
from ...master.scene.run_spec import UNITS
from ...master.scene.scene import ComponentSpec, Scene
from ...modelkit.variables import Causality
from ...studies.drop.impact_watch import AVERAGING_TIME
from ...studies.rotor.mode_error import scene_mode_error
from ..charts import inline
from ..figures.energy import energy
from ..layout import Data
from ..numbers import NONE, capital, digits, percentage, quantity
from ..subject import Subject, run_origin

FOREIGN_FMU = "an FMU from elsewhere; its own documentation says what is in it"
LEFT_OUT = {  # model: what it has not, by the words of its template
    "angular_caged": ("spinning", "lands"),
    "angular_cageless": ("spinning",),
    "angular_simplified": ("angular bodies",),
    "rigid_rotor": ("tilting",),
    "simplified_caged": ("planar", "caged bodies"),
    "simplified_cageless": ("planar", "inertia"),
    "detailed_caged": ("planar",),
    "detailed_cageless": ("planar",),
    "bushing": ("planar", "rolling"),
    "landing_sleeve": ("rolling",),
}
LINE_ENDS = re.compile(r"(?<=[.:])[ \t]*\n|\n[ \t]*\n|\n(?=[ \t]*[-*] )")  # of prose, which may be wrapped
TAMES = "tames rare large ball loads, above all on a soft mount"


BODIES = ("detailed_caged", "detailed_cageless", "angular_caged", "angular_cageless")  # their balls are
THROWN = "balls.centrifugal"
BRAKE, HOOP = "brake_points", "ring.hoop"
EFFECTS = {  # what speed, heat and a brake do, by the parameter that switches it on
    "ring.growth": "Rings and journal grow by their spin",
    HOOP: "Rings give all around under the balls (hoop)",
    THROWN: "Centrifugal force of balls",
    "thermal": "Parts grow by heat",
    BRAKE: "A brake on the rotor",
}


def model(subject: Subject) -> Data:
    """Of each part what it is, then what is in none."""
    scene = subject.result.scene
    assumed = _to_ask_for(subject)
    return {
        "about": [" ".join(line.split()) for line in LINE_ENDS.split(scene.about.strip())],
        "parts": [[name, spec.fmu, _about(subject, spec)] for name, spec in scene.components.items()],
        "scheme": scene.run.scheme.title,
        "macro_step": quantity(scene.run.macro_step, "s"),
        "assumed": assumed,
        "command": _to_see_what_they_do(subject) if assumed else "",
        "left_out": _left_out(subject),
        "effects": [_effect(subject, variable) for variable in EFFECTS],
        "axial": _is_on(subject, "axial"),
        "thermal": _is_on(subject, "thermal"),
        "controlled": bool(scene.control),
        "bending": _is_on(subject, "ring.harmonics"),
    }


MOUNT = {  # likewise, of what a bearing sits in
    "stiffness": ("stiffness of its mount", "decides forces and stroke, and where a whirl can be"),
    "damping": ("damping of its mount", "ends a whirl, or lets it grow"),
}
TO_ASK_FOR = {  # variables that few know, the gravest first: what they are, and what they decide
    "friction.dynamic": (
        "friction of the journal in its bore, a ratio",
        "drives a whirl, spins the ring",
    ),
    **MOUNT,
    "clearance": ("its radial clearance", "decides the fall, and how fast a whirl is"),
    "rolling.resistance": ("the drag of its balls", "sustains a whirl, which grows with it"),
    "balls.damping_ratio": ("damping of its balls on races, a ratio", TAMES),
    "balls.dissipation": ("the same by restitution, s/m", TAMES),
    "balls.damping": ("the same by indentation, N s/m\N{SUPERSCRIPT TWO}", TAMES),
}
TO_TRY = (  # drag and damping of the balls, and what to try where they have none
    (("rolling.resistance",), 0.0015),
    (("balls.damping_ratio", "balls.dissipation", "balls.damping"), 0.02),
)


def _to_ask_for(subject: Subject) -> list[list[str]]:
    """Numbers that decide and are assumed, unless somebody measured them."""
    components, system = subject.result.scene.components, subject.run.system
    ports = (housing_port(system, a.bearing) for a in subject.seats)
    mounts = {port.partition(".")[0] for port in ports if port}
    return [
        [full, what, _valued(subject, name, variable), str(setting_origin(spec, variable)), decides]
        for variable, (what, decides) in TO_ASK_FOR.items()
        for name, spec in components.items()
        if (full := f"{name}.{variable}") in system and (name in mounts) == (variable in MOUNT)
    ]


def _valued(subject: Subject, name: str, variable: str) -> str:
    value, known = subject.run.system.value(f"{name}.{variable}"), subject.run.system.components[name]
    return _shown(known.variables[variable], value) if value else "0: none"


def _to_see_what_they_do(subject: Subject) -> str:
    """The sweep that tells what drag and damping of the balls do in this scene; "": there is none."""
    scene, system = subject.result.scene, subject.run.system
    command = _command_of(scene)
    if command is None or " --swap " in command:  # which a sweep does not take
        return ""
    words = [command.replace(" run ", " sweep ", 1), "--in-process"]
    for variables, usual in TO_TRY:
        known = [f"{part}.{one}" for one in variables for part in scene.components]
        known = [full for full in known if full in system]
        if not known:
            continue
        most = max((system.value(full) for full in known), default=0.0)
        varied = [full for full in known if system.value(full) == most > 0.0]
        varied = varied or [full for full in known if full.endswith(variables[0])]
        values = f"{most:g},{2.0 * most:g}" if most > 0.0 else f"0,{usual:g}"
        words += ["--vary", shlex.quote(f"{','.join(varied)}={values}")]
    return " ".join(words)


def _about(subject: Subject, spec: ComponentSpec) -> str:
    """The description of a model."""
    path = subject.result.scene.folder / spec.fmu
    name = str(path) if spec.fmu.endswith(".toml") and path.is_file() else spec.fmu
    if name not in fmu_names() and not name.endswith(".toml"):
        return FOREIGN_FMU
    try:
        return recipe(name).model.about
    except (LookupError, OSError, TouchdownError):
        return "a rotor's file that is not there any more, or not as it was"


def _left_out(subject: Subject) -> dict[str, str]:
    """What the models of the parts have not, and which of them."""
    by_reason: dict[str, list[str]] = {}
    for name, spec in subject.result.scene.components.items():
        for what in LEFT_OUT.get(spec.fmu, ()):
            by_reason.setdefault(what, []).append(name)
    return {what: joined(names) for what, names in by_reason.items()}


def _effect(subject: Subject, variable: str) -> list[str]:
    """An effect, the parts that have it in this run, and those in which it is left out."""
    system, fmus = subject.run.system, subject.result.scene.components
    parts = {a.body if variable == BRAKE else a.bearing: None for a in subject.seats}
    known = [name for name in parts if variable == BRAKE or f"{name}.balls.count" in system]
    parted: tuple[list[str], list[str]] = [], []  # in, left out in
    for name in known:
        full, always = f"{name}.{variable}", variable == THROWN and fmus[name].fmu in BODIES
        acts = always or (full in system and system.value(full) != 0.0)
        parted[not acts].append(f"{name}{_outer_seat(subject, name) if variable == HOOP else ''}")
    return [EFFECTS[variable], *(joined(names) or NONE for names in parted)]


def _outer_seat(subject: Subject, name: str) -> str:
    """How the outer ring of a bearing whose rings may give sits, in brackets; "": it is always held."""
    seat, system = "outer_ring.seat", subject.run.system
    if f"{name}.{seat}" not in system:
        return ""
    variable = system.components[name].variables[seat]
    return f" (outer ring {variable.in_words(system.value(f'{name}.{seat}'))})"


def _is_on(subject: Subject, variable: str) -> bool:
    """Whether a component of the scene has this parameter, and not at 0."""
    system = subject.run.system
    names = (f"{name}.{variable}" for name in subject.result.scene.components)
    return any(name in system and system.value(name) != 0.0 for name in names)


# Of the turnover: what the coupling makes or loses says nothing against the figures
NEGLIGIBLE_RESIDUAL = 1e-3
SHARES = (
    *("energy_residual_of_turnover", "energy_made_of_turnover", "energy_made_inside_of_turnover"),
    *("energy_made_in_system_of_turnover", "energy_balance_relative"),
)
TOLD = (
    *(*SHARES, "energy_turnover", "energy_made", "energy_residual_worst_connection"),
    *("scheme", "macro_step", "macro_steps", "wall_time"),
)
BALANCES = "energy_made_inside_of_turnover", "energy_made_in_system_of_turnover"


def accuracy(subject: Subject) -> Data:
    """Ledger, steps, energies."""
    energy_made = subject.summary["energy_made_of_turnover"]
    rows = [
        [capital(i.words), _told(i.quantity, value)]
        for i in summary_items(subject.summary)
        if i.quantity.key in TOLD and (value := i.of(subject.summary)) is not None
    ]
    return {
        "judged": None if energy_made is None else _judged(subject, energy_made),
        "rows": rows,
        "unaudited": subject.summary["not_audited"],
        "modes": _cost_of_modes(subject),
        "averaged": quantity(AVERAGING_TIME, "s"),
        "energies": _energies(subject),
    }


def _told(one: Quantity, value: Any) -> str:
    """A value as text, shares in per cent."""
    if one.key in SHARES:
        return percentage(value)
    return quantity(value, one.unit) if one.unit else value


def _cost_of_modes(subject: Subject) -> list[Data]:
    """The error of the first impact by the number of modes that the rotor keeps, where it keeps not all."""
    scene, system = subject.result.scene, subject.run.system
    bodies = dict.fromkeys(a.body for a in subject.seats)
    return [
        {
            "body": body,
            "kept": cost.modes,
            "contact": percentage(cost.contact),
            "journal": percentage(cost.journal),
        }
        for body in bodies
        if (cost := scene_mode_error(scene, system, body)) is not None
    ]


def _judged(subject: Subject, energy_made: float) -> Data:
    """What the coupling made of the energy that crossed it, in all, at worst and beyond the limit."""
    worst = subject.summary["energy_residual_of_turnover"] or 0.0  # made and lost may cancel
    limit = energy_share(subject.result.scene.run.warn_residual)
    inside, system = (found if (found := subject.summary[key] or 0.0) > limit else None for key in BALANCES)
    return {
        "gained": energy_made > 0.0,
        "made": percentage(abs(energy_made)),
        "worst": percentage(worst) if worst > abs(energy_made) else "",
        "inside": percentage(inside) if inside else "",
        "system": percentage(system) if system else "",
        "sound": max(abs(energy_made), worst) <= NEGLIGIBLE_RESIDUAL and not inside and not system,
    }


def _energies(subject: Subject) -> str:
    """The picture; "": not all parts state and record their energies."""
    if energy_total(subject.run.system, subject.run.recording) is None:
        return ""
    alt = "Energies of all parts over time, and their sum, which should stay"
    return inline(partial(energy, run=subject.run), "energy", alt, wide=True)


def settings(subject: Subject) -> Data:
    """Tables by part: what is not the default first, the defaults folded."""
    scene = subject.result.scene
    return {
        "run": [
            [f"run.{key}", _run_value(key, value), run_origin(scene, key).value]
            for key, value in asdict(scene.run).items()
        ],
        "parts": [_component(subject, name) for name in subject.run.system.components],
    }


def _run_value(key: str, value: object) -> str:
    if isinstance(value, dict):  # the scheme
        return str(value["name"])
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, float)):
        return quantity(float(value), UNITS.get(key, "1"), 6)
    if isinstance(value, (tuple, list)):
        return ", ".join(str(part) for part in value) or "–"
    return str(value)


def _component(subject: Subject, name: str) -> Data:
    spec, component = subject.result.scene.components[name], subject.run.system.components[name]
    chosen, defaults = list[list[str]](), list[list[str]]()
    for variable in component.variables.values():
        if variable.causality is Causality.PARAMETER:
            origin = setting_origin(spec, variable.name)
            value = _shown(variable, subject.run.system.value(f"{name}.{variable.name}"))
            row = [f"{name}.{variable.name}", value, origin.value, variable.description]
            (defaults if origin is Origin.DEFAULT else chosen).append(row)
    heading = f"{name}: {spec.fmu}" + (f", catalogue {spec.preset}" if spec.preset else "")
    return {"made": heading, "chosen": chosen, "defaults": defaults}


def _shown(variable: ScalarVariable, value: float) -> str:
    """A setting's value with its unit, or the word of a choice."""
    if variable.choices:
        return variable.in_words(value)
    text = quantity(float(value), variable.unit or "1", 6)
    turns, per = display_value(variable.name, value)
    return f"{text} ({digits(turns, 6)} {per})" if variable.unit == "rad/s" and value else text


LIBRARIES = ("numba", "numpy", "scipy", "fmpy", "matplotlib")


def repeat(subject: Subject) -> Data:
    """Command, scene, versions."""
    scene = subject.result.scene
    text = json.dumps(scene.resolved(), indent=2, default=str) + "\n"
    file = f"{scene.name}.scene.json"
    return {
        "command": _command_of(scene),
        "again": f"touchdown run {shlex.quote(file)} -o runs/again",
        "file": file,
        "base64": base64.b64encode(text.encode()).decode("ascii"),
        "versions": _versions(subject),
    }


def _command_of(scene: Scene) -> str | None:
    """The `touchdown run` that runs the scene again; None where it is of no file."""
    name = _source(scene)
    if name is None:
        return None
    words = ["touchdown", "run", name]
    for component, spec in scene.components.items():
        if spec.instead_of:
            words += ["--swap", f"{component}={spec.fmu}"]
    for key in scene.own:
        words += ["--set", f"run.{key}={_value(scene.resolved()['run'], key)}"]
    for component, spec in scene.components.items():
        for key, value in (
            ("every", spec.every),
            ("sampled", spec.sampled),
            ("isolate", spec.isolate),
            ("native", spec.native),
        ):
            if value != getattr(ComponentSpec, key):  # said again where the scene's file says it, too
                words += ["--set", f"{component}.{key}={str(value).lower()}"]
        for variable, value in spec.set_beside.items():
            words += ["--set", f"{component}.{variable}={value}"]
    return shlex.join(words)


def _value(run: object, key: str) -> object:
    assert isinstance(run, dict)
    value = run[key]
    return ",".join(value) if isinstance(value, (tuple, list)) else value


def _source(scene: Scene) -> str | None:
    """The name of the scene in a command."""
    path = scene.folder / f"{scene.name}.toml"
    if path.is_file():
        return (
            scene.name
            if path.resolve() == shipped_scenes().get(scene.name, Path()).resolve()
            else str(path)
        )
    is_machine = scene.folder.resolve().name == scene.name and (scene.folder / SCENE_FILE).is_file()
    return str(scene.folder) if is_machine else None


def _versions(subject: Subject) -> list[list[str]]:
    ran = str(subject.run.recording.about().get("version", "not recorded"))
    rows = [["touchdown-cosim, of the run", ran], ["touchdown-cosim, of this report", VERSION]]
    rows.append(["Python, of this report", platform.python_version()])
    return rows + [[f"{name}, of this report", metadata.version(name)] for name in LIBRARIES]
