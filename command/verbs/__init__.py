"""The verbs of the command `touchdown`, in the groups and the order of its help."""

from __future__ import annotations

from collections.abc import Mapping

from . import comparisons, dissertation, fmus, imports, loops, machines, runs, sweeps, validate, whirls
from .verb import Verb

GROUPS: Mapping[str, tuple[Verb, ...]] = {
    "your machine": (
        machines.NEW,
        machines.SCENES,
        machines.CATALOGUE,
        machines.ROTOR,
        imports.IMPORT_ROTOR,
        imports.IMPORT_MOUNT,
        imports.IMPORT_FOUNDATION,
    ),
    "run and look": (
        runs.RUN,
        runs.REPORT,
        runs.ANIMATE,
    ),
    "studies": (
        sweeps.SWEEP,
        whirls.VERDICT,
        whirls.WHIRL,
        sweeps.SURVIVE,
        sweeps.CHOOSE,
        loops.LOOP,
        comparisons.COMPARE,
    ),
    "the source and others": (
        dissertation.FIGURE,
        validate.VALIDATE,
    ),
    "FMUs and systems": (
        fmus.BUILD,
        fmus.CHECK,
        fmus.SSP,
        fmus.CACHE,
    ),
}
ALL: tuple[Verb, ...] = tuple(verb for group in GROUPS.values() for verb in group)
