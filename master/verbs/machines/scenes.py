"""List the scenes, or show one."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import spoken
from touchdown.master.verbs import completion
from touchdown.master.verbs.arguments import add_scene_name
from touchdown.master.verbs.completion import complete
from touchdown.master.verbs.verb import Verb
from touchdown.modelkit.units import display_unit, per_display

if TYPE_CHECKING:
    from touchdown.master.components.component import Variable
    from touchdown.master.scene.scene import Scene

EXAMPLES = (
    "touchdown scenes",
    "touchdown scenes rotor1-9000",
    "touchdown scenes disk-caged-simplified --variables bearing",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb, "show this scene's components and settings", nargs="?")
    named = verb.add_argument(
        "--variables", metavar="COMPONENT", help="show what can be set in this component of the scene"
    )
    complete(named, completion.components)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.scene.file import shipped

    if options.scene is None:
        names = shipped()
        width = max(len(name) for name in names)
        for name in names:
            print(f"  {name:<{width}}  {find_scene(name).title}")
        return 0
    chosen = find_scene(options.scene)
    print("\n".join(filter(None, (chosen.title, chosen.about.strip()))))
    begins = f"begins at t = {chosen.run.start_time:g} s, " if chosen.run.start_time else ""
    print(
        f"\nrun: {begins}{chosen.run.duration:g} s from {chosen.zero or 'the start'}, "
        f"macro step {_time(chosen.run.macro_step)}, scheme {chosen.run.scheme.name}"
    )
    if options.variables is not None:
        _show_variables(chosen, options.variables)
        return 0
    for name, spec in chosen.components.items():
        settings = "".join(f"\n      {key} = {_plainly(value)}" for key, value in spec.set.items())
        kind = f" ({spec.preset})" if spec.preset else ""
        print(f"  {name}: {spec.fmu}{kind}{settings}")
    for bearing, body in chosen.attach:
        print(f"  {bearing} on {body}")
    return 0


def _time(seconds: float) -> str:
    unit = display_unit("s", seconds)
    return f"{per_display('s', unit) * seconds:g} {unit}"


def _plainly(value: object) -> str:
    """A setting as a file has it."""
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _show_variables(scene: Scene, name: str) -> None:
    """All that `--set NAME.VARIABLE=VALUE` takes: value in this scene, unit, bounds in it, meaning."""
    from touchdown.master.coupling.simulation import opened

    with opened(scene, in_process=True) as system:
        component = system.components.get(name)
        if component is None:
            known = one_of(name, system.components)
            raise TouchdownError(f"scene {scene.name} has no component {name}; {known}")
        settable = [v for v in component.variables.values() if v.settable and v.causality == "parameter"]
        values = component.read([v.name for v in settable])
        print(f"\n{name} ({component.origin})")
        for v, value in zip(settable, values, strict=True):
            told, unit, bounds = _as_shown(v, value)
            print(f"  {v.name:<34}{told:>12} {unit:<10}{bounds:<18} {v.description}")


def _as_shown(variable: Variable, value: float) -> tuple[str, str, str]:
    """Value, unit and bounds as people read them; a choice is a word, and has neither of these."""
    if variable.choices:
        return variable.told(value), "", ""
    unit = variable.unit or "1"
    shown = unit if spoken(variable.name, 0.0)[1] == "Hz" else display_unit(unit, value)
    factor = per_display(unit, shown)
    ends = (("from", variable.minimum), ("to", variable.maximum))
    bounds = " ".join(f"{word} {factor * bound:g}" for word, bound in ends if bound is not None)
    return f"{factor * value:.6g}", "" if shown == "1" else shown, bounds


VERB = Verb("scenes", "list the scenes, or show one", EXAMPLES, declare, execute)
