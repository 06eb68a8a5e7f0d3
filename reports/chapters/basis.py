"""Chapters on what the figures rest on: model, accuracy, settings, how to repeat the run."""

from __future__ import annotations

import base64
import json
import platform
import shlex
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any

from ...fmus.recipes import names, recipe
from ...fmus.version import VERSION
from ...master.common.errors import TouchdownError
from ...master.common.text import display_value
from ...master.components.component import Variable
from ...master.coupling.ledger.alarms import energy_share
from ...master.quantities import Quantity, items
from ...master.results.ratings import Origin, setting_origin
from ...master.results.summary import energy_total
from ...master.scene.file import SCENE_FILE, shipped
from ...master.scene.run_spec import UNITS
from ...master.scene.scene import ComponentSpec, Scene
from ...modelkit.variables import Causality
from ...studies.drop.first_impact import AVERAGING_TIME
from ...studies.rotor.mode_error import scene_mode_error
from ..blocks import Block, Code, Download, Folded, Heading, Lacking, Picture, Points, Table, Text
from ..charts import inline
from ..figures.energy import energy
from ..numbers import capital, digits, listed, percentage, quantity
from ..subject import Subject, run_origin

FOREIGN_FMU = "an FMU from elsewhere; its own documentation says what is in it"
IN_THE_PLANE = "Axial motion and axial loads: all is in the radial planes of the bearings."
ALONG = "Tilt of the bearings' outer rings and housings."
RIGID_RINGS = (
    "Bending of the bearings' rings and of the housing: they are rigid, but for contacts and springs."
)
BENDING_RINGS = "Bending of the outer rings, which their seats hold round, and of the housing."
COLD_GAPS = (
    "Temperature: friction's heat is counted, by part, but what it warms does not expand in the run; the "
    "chapter on heat says what that would come to."
)
WARM_GAPS = (
    "Temperature but for the bearings' gaps, which follow it (thermal = 1): the rotor and the laws of "
    "friction stay as they are."
)
ALWAYS_LEFT_OUT = (
    "Lubricant, wear and damage: the laws of friction and contact stay the same, drop after drop.",
    "Forces of the process, the motor and the magnetic bearings after the shutdown, but for what a drag or "
    "an FMU of the scene states.",
)
SPINNING_BALLS = "In {name}, friction of balls that spin about the normal of a contact."
FIXED_BORE = "Anything that rolls in {name}: the bore is fixed in the housing."
PLANAR = "Motion along the shaft and its tilt at {name}: it is planar."
LEFT_OUT = {  # model: what it has not
    "angular_caged": (SPINNING_BALLS, "Lands on the rings of {name} that guide its cages; balls alone do."),
    "angular_cageless": (SPINNING_BALLS,),
    "angular_simplified": (
        "Balls and cage of {name} as bodies: they follow the ring; and what a ball's inertia does across "
        "the race.",
    ),
    "rigid_rotor": ("The rotor's tilting and bending: it is a disc that moves in one plane.",),
    "simplified_caged": (
        PLANAR,
        "Balls and cage of {name} as bodies: they follow the ring, unless slip = 1; and what a ball's "
        "inertia does across the race.",
    ),
    "simplified_cageless": (PLANAR, "Inertia and weight of the balls of {name} across the race."),
    "detailed_caged": (PLANAR,),
    "detailed_cageless": (PLANAR,),
    "bushing": (PLANAR, FIXED_BORE),
    "landing_sleeve": (FIXED_BORE,),
}
TAMES = "tames rare large ball loads, above all on a soft mount"
SCHEME = "How the parts were coupled: {title}; macro step {step}."


def model(subject: Subject) -> list[Block]:
    """Of each part what it is, then what is in none."""
    scene = subject.result.scene
    about = " ".join(scene.about.split())
    rows = [[name, spec.fmu, _about(subject, spec)] for name, spec in scene.components.items()]
    blocks: list[Block] = [Text(about)] if about else []
    run = scene.run
    return [
        *blocks,
        Table("What each part is modelled as", ["Part", "Model", "What is in it"], rows),
        Text(SCHEME.format(title=run.scheme.title, step=quantity(run.macro_step, "s"))),
        *_to_ask_for(subject),
        Heading("Left out"),
        Points(list(_left_out(subject))),
    ]


TO_ASK_FOR = {  # variables of a bearing that few know: what they are, and what they decide
    "rolling.resistance": ("the drag of its balls", "sustains a whirl, which grows with it"),
    "balls.damping_ratio": ("damping of its balls on races, a ratio", TAMES),
    "balls.dissipation": ("the same by restitution, s/m", TAMES),
    "balls.damping": ("the same by indentation, N s/m\N{SUPERSCRIPT TWO}", TAMES),
}
TO_TRY = (  # drag and damping of the balls, and what to try where they have none
    (("rolling.resistance",), 0.0015),
    (("balls.damping_ratio", "balls.dissipation", "balls.damping"), 0.02),
)


def _to_ask_for(subject: Subject) -> list[Block]:
    """Numbers of the bearings that decide and are assumed, unless somebody measured them."""
    scene, system = subject.result.scene, subject.run.system
    rows = [
        [f"{name}.{variable}", what, f"{value:g}" if value else "0: none", str(origin), decides]
        for name, spec in scene.components.items()
        for variable, (what, decides) in TO_ASK_FOR.items()
        if f"{name}.{variable}" in system
        for value, origin in [(system.value(f"{name}.{variable}"), setting_origin(spec, variable))]
    ]
    head = ["Setting", "What it is", "Value", "from", "What it does"]
    if not rows:
        return []
    return [Table("Assumed, and worth asking for", head, rows), *_to_see_what_they_do(subject)]


def _to_see_what_they_do(subject: Subject) -> list[Block]:
    """The sweep that tells what drag and damping of the balls do in this scene."""
    scene, system = subject.result.scene, subject.run.system
    command = command_of(scene)
    if command is None or " --swap " in command:  # which a sweep does not take
        return []
    words = [command.replace(" run ", " sweep ", 1), "--in-process"]
    for variables, usual in TO_TRY:
        known = [f"{part}.{one}" for one in variables for part in scene.components]
        known = [full for full in known if full in system]
        most = max((system.value(full) for full in known), default=0.0)
        varied = [full for full in known if system.value(full) == most > 0.0]
        varied = varied or [full for full in known if full.endswith(variables[0])]
        values = f"{most:g},{2.0 * most:g}" if most > 0.0 else f"0,{usual:g}"
        words += ["--vary", shlex.quote(f"{','.join(varied)}={values}")]
    return [Text("This sweep shows what they do in this scene:"), Code(" ".join(words))]


def _about(subject: Subject, spec: ComponentSpec) -> str:
    """The description of a model."""
    path = subject.result.scene.folder / spec.fmu
    name = str(path) if spec.fmu.endswith(".toml") and path.is_file() else spec.fmu
    if name not in names() and not name.endswith(".toml"):
        return FOREIGN_FMU
    try:
        return recipe(name).model.about
    except (LookupError, OSError, TouchdownError):
        return "a rotor's file that is not there any more, or not as it was"


def _left_out(subject: Subject) -> Iterator[str]:
    by_reason: dict[str, list[str]] = {}
    for name, spec in subject.result.scene.components.items():
        for text in LEFT_OUT.get(spec.fmu, ()):
            by_reason.setdefault(text, []).append(name)
    yield from (text.format(name=listed(names)) for text, names in by_reason.items())
    yield ALONG if _is_on(subject, "axial") else IN_THE_PLANE
    yield WARM_GAPS if _is_on(subject, "thermal") else COLD_GAPS
    yield from ALWAYS_LEFT_OUT
    yield BENDING_RINGS if _is_on(subject, "ring.harmonics") else RIGID_RINGS


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
BALANCES = {
    "energy_made_inside_of_turnover": "inside the worst bearing",
    "energy_made_in_system_of_turnover": "in the system as a whole",
}


def accuracy(subject: Subject) -> list[Block]:
    """Ledger, steps, energies."""
    rows = [
        [capital(i.words), _told(i.quantity, value)]
        for i in items(subject.summary)
        if i.quantity.key in TOLD and (value := i.of(subject.summary)) is not None
    ]
    blocks: list[Block] = [
        *_judged(subject),
        Table("What the ledger and the steps say", ["Figure", "Value"], rows, 1),
    ]
    if unaudited := subject.summary["not_audited"]:
        blocks.append(Lacking("The account of", f"{unaudited}."))
    return [*blocks, *_cost_of_modes(subject), _energies(subject)]


def _told(one: Quantity, value: Any) -> str:
    """A value as text, shares in per cent."""
    if one.key in SHARES:
        return percentage(value)
    return quantity(value, one.unit) if one.unit else value


def _cost_of_modes(subject: Subject) -> Iterator[Block]:
    """The error of the first impact by the number of modes that the rotor keeps, where it keeps not all."""
    scene, system = subject.result.scene, subject.run.system
    for body in dict.fromkeys(a.body for a in subject.seats):
        cost = scene_mode_error(scene, system, body)
        if cost is not None:
            journal, span = percentage(cost.journal), quantity(AVERAGING_TIME, "s")
            yield Text(
                f"{body} keeps {cost.modes} modes per plane. In a first impact that puts the momentary "
                f"contact force within {percentage(cost.contact)} of the one with all modes, and the force "
                f"on a journal in the mean over {span} within {journal}. Estimated by a level fall without "
                "spin; `touchdown compare --of modes` runs the scene itself."
            )


def _judged(subject: Subject) -> list[Block]:
    made = subject.summary["energy_made_of_turnover"]
    if made is None:
        return [Lacking("A judgement by energy", "no energy crossed between parts that account for it.")]
    verb = "made" if made > 0.0 else "lost"
    text = f"The coupling {verb} {percentage(abs(made))} of the energy that crossed it"
    worst = subject.summary["energy_residual_of_turnover"] or 0.0  # made and lost may cancel
    if worst > abs(made):
        text += f", and at one connection {percentage(worst)} of the energy that crossed there"
    limit, sound = energy_share(subject.result.scene.run.warn_residual), True
    for key, where in BALANCES.items():
        found = subject.summary[key] or 0.0
        if found > limit:
            sound = False
            text += f"; {where} {percentage(found)} of the turnover was made or lost"
    if max(abs(made), worst) <= NEGLIGIBLE_RESIDUAL and sound:
        return [Text(f"{text}: as far as energy shows, the macro step is fine enough for these figures.")]
    return [
        Text(
            f"{text}: forces and times may be off by as much and more. A run with half the macro step "
            "shows how much depends on it, and `touchdown compare` gives the error by macro step."
        )
    ]


def _energies(subject: Subject) -> Block:
    if energy_total(subject.run.system, subject.run.recording) is None:
        return Lacking("Where the energy is", "not all parts state and record their energies.")
    alt = "Energies of all parts over time, and their sum, which should stay"
    svg = inline(partial(energy, run=subject.run), "energy", alt, wide=True)
    return Picture(svg, "Where the energy is, and the balance of all: zero where nothing is lost or made.")


HEAD = ["Setting", "Value", "Origin", "Meaning"]


def settings(subject: Subject) -> list[Block]:
    """Tables by part: what is not the default first, the defaults folded."""
    blocks: list[Block] = [
        Text(
            "Values as they were in force. The origin is the last that set the value: the default of the "
            "model, the catalogue of bearings, the scene, or what was set for this run "
            "(--set, --swap, or from Python)."
        ),
        _run(subject),
    ]
    for name, component in subject.run.system.components.items():
        blocks += _component(subject, name, component.variables)
    return blocks


def _run(subject: Subject) -> Table:
    scene = subject.result.scene
    rows = [
        [f"run.{key}", _run_value(key, value), run_origin(scene, key).value]
        for key, value in asdict(scene.run).items()
    ]
    return Table("How it was run", HEAD[:3], rows)


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


def _component(subject: Subject, name: str, variables: Mapping[str, Variable]) -> Iterator[Block]:
    rows: dict[bool, list[list[str]]] = {True: [], False: []}
    for variable in variables.values():
        if variable.causality is Causality.PARAMETER:
            origin = setting_origin(subject.result.scene.components[name], variable.name)
            value = subject.run.system.value(f"{name}.{variable.name}")
            row = [f"{name}.{variable.name}", shown(variable, value), origin.value, variable.description]
            rows[origin is Origin.DEFAULT].append(row)
    spec = subject.result.scene.components[name]
    made = f"{name}: {spec.fmu}" + (f", catalogue {spec.preset}" if spec.preset else "")
    if rows[False]:
        yield Table(made, HEAD, rows[False])
    if rows[True]:
        table = Table(f"{made}, defaults", HEAD, rows[True])
        title = f"{made}: {len(rows[True])} settings at their defaults"
        yield Folded(title, [table])


def shown(variable: Variable, value: float) -> str:
    """A setting's value with its unit."""
    text = quantity(float(value), variable.unit or "1", 6)
    turns, per = display_value(variable.name, value)
    return f"{text} ({digits(turns, 6)} {per})" if variable.unit == "rad/s" and value else text


LIBRARIES = ("numba", "numpy", "scipy", "fmpy", "matplotlib")


def repeat(subject: Subject) -> list[Block]:
    """Command, scene, versions."""
    scene = subject.result.scene
    blocks: list[Block] = []
    command = command_of(scene)
    if command is None:
        blocks.append(
            Lacking("The command with the scene's own file", "the scene was made in Python, or renamed.")
        )
    else:
        blocks += [Text("From the scene's file, with what was set for this run:"), Code(command)]
    text = json.dumps(scene.resolved(), indent=2, default=str) + "\n"
    blocks += [
        Text("Or from the scene as it was run, whatever becomes of that file:"),
        Code(f"touchdown run {shlex.quote(f'{scene.name}.scene.json')} -o runs/again"),
        Download(
            f"{scene.name}.scene.json",
            "The scene as it was run",
            "application/json",
            base64.b64encode(text.encode()).decode("ascii"),
        ),
        _versions(subject),
    ]
    return blocks


def command_of(scene: Scene) -> str | None:
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
    own = scene.folder / f"{scene.name}.toml"
    if own.is_file():
        return scene.name if own.resolve() == shipped().get(scene.name, Path()).resolve() else str(own)
    is_machine = scene.folder.resolve().name == scene.name and (scene.folder / SCENE_FILE).is_file()
    return str(scene.folder) if is_machine else None


def _versions(subject: Subject) -> Table:
    ran = str(subject.run.recording.about().get("version", "not recorded"))
    rows = [["touchdown-cosim, of the run", ran], ["touchdown-cosim, of this report", VERSION]]
    rows.append(["Python, of this report", platform.python_version()])
    rows += [[f"{name}, of this report", metadata.version(name)] for name in LIBRARIES]
    return Table("Versions", ["What", "Version"], rows)
