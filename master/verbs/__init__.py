"""The verbs of the command `touchdown`, in the groups and the order of its help."""

from __future__ import annotations

from collections.abc import Mapping

from . import comparisons, dissertation, fmus, loops, machines, runs, sweeps, validate
from .verb import Verb

GROUPS: Mapping[str, tuple[Verb, ...]] = {
    "your machine": (
        machines.NEW,
        machines.SCENES,
        machines.CATALOGUE,
        machines.ROTOR,
        machines.IMPORT_ROTOR,
        machines.IMPORT_MOUNT,
        machines.IMPORT_FOUNDATION,
    ),
    "run and look": (
        runs.RUN,
        runs.REPORT,
        runs.ANIMATE,
    ),
    "studies": (
        sweeps.SWEEP,
        sweeps.MERGE,
        sweeps.VERDICT,
        sweeps.WHIRL,
        sweeps.SURVIVE,
        sweeps.CHOOSE,
        loops.LOOP,
        comparisons.COMPARE,
        comparisons.COMPARE_MODES,
        comparisons.ADVISE,
        comparisons.STABILITY,
    ),
    "the source and others": (
        dissertation.FIGURE,
        dissertation.COMPARE_BEARINGS,
        dissertation.COMPARE_ROTORS,
        validate.VALIDATE,
    ),
    "FMUs and systems": (
        fmus.BUILD,
        fmus.CHECK,
        fmus.SSP,
        fmus.CONTAINER,
        fmus.DOCTOR,
        fmus.CACHE,
    ),
}
ALL: tuple[Verb, ...] = tuple(verb for group in GROUPS.values() for verb in group)
