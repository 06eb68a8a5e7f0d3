"""Say which macro steps the schemes bear in a scene."""

from __future__ import annotations

import argparse

from touchdown.master.verbs.arguments import add_scene_name, add_settings, settings
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown advise rotor1-9000",
    "touchdown advise disk-caged-simplified --set bearing.preset=6014",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb)
    add_settings(verb, "set COMPONENT.VARIABLE")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.scene.schemes import SCHEMES
    from touchdown.master.studies.schemes.advisor import advise

    chosen = find_scene(options.scene).set(settings(options))
    advice = advise(chosen, SCHEMES)
    reason = advice[chosen.run.scheme.name].reason
    print(f"{chosen.name}: {reason}")
    print(
        f"It takes {1e6 * chosen.run.macro_step:g} us. With what is advised, peaks of the first impact are"
    )
    print("within about 1 %; what longer steps do is in the ledger of a run.")
    for name, advised in advice.items():
        scheme = SCHEMES[name]
        print(f"  {name:<18}{1e6 * advised.macro_step:>10g} us   {scheme.bears:>5g} rad   {scheme.title}")
    return 0


VERB = Verb("advise", "which macro step each coupling scheme bears in a scene", EXAMPLES, declare, execute)
