"""What was modelled, and what was left out."""

from __future__ import annotations

from collections.abc import Iterator

from touchdown.fmus.recipes import names, recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.report.facts.numbers import quantity
from touchdown.master.report.facts.subject import Subject
from touchdown.master.report.page.blocks import Block, Heading, Points, Table, Text
from touchdown.master.scene.scene import ComponentSpec
from touchdown.modelkit.model import ModelError

FOREIGN = "an FMU of another's; its own documentation says what is in it"
ALWAYS_LEFT_OUT = (
    "Axial motion and axial loads: all is in the radial planes of the bearings.",
    "Temperature: friction's heat is counted in the energy ledger, but nothing warms up or expands.",
    "Lubricant, wear and damage: the laws of friction and contact stay the same, drop after drop.",
    "Forces of the process, the motor and the magnetic bearings after the shutdown, but for what a drag or "
    "an FMU of the scene states.",
    "Bending of the bearings' rings and of the housing: they are rigid, but for contacts and springs.",
)
LEFT_OUT = {  # model: what it has not
    "rigid_rotor": ("The rotor's tilting and bending: it is a disc that moves in one plane.",),
    "simplified_caged": (
        "Balls and cage of {name} as bodies: they follow the ring, unless slip = 1; and what a ball's "
        "inertia does across the race.",
    ),
    "simplified_cageless": ("Inertia and weight of the balls of {name} across the race.",),
    "bushing": ("Anything that rolls in {name}: the bore is fixed in the housing.",),
}
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
        Heading("Left out"),
        Points(list(_left_out(subject))),
    ]


def _about(subject: Subject, spec: ComponentSpec) -> str:
    """What a model says of itself."""
    path = subject.result.scene.folder / spec.fmu
    name = str(path) if spec.fmu.endswith(".toml") and path.is_file() else spec.fmu
    if name not in names() and not name.endswith(".toml"):
        return FOREIGN
    try:
        return recipe(name).model.about
    except (LookupError, ModelError, OSError, TouchdownError):
        return "a rotor's file that is not there any more, or not as it was"


def _left_out(subject: Subject) -> Iterator[str]:
    said: dict[str, list[str]] = {}
    for name, spec in subject.result.scene.components.items():
        for text in LEFT_OUT.get(spec.fmu, ()):
            said.setdefault(text, []).append(name)
    yield from (text.format(name=" and ".join(names)) for text, names in said.items())
    yield from ALWAYS_LEFT_OUT
