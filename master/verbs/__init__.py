"""The verbs of the command `touchdown`, one module each; `ALL` is in the order of its help."""

from __future__ import annotations

from touchdown.master.verbs import run
from touchdown.master.verbs.fmus import build, cache, check, container, doctor, ssp
from touchdown.master.verbs.machines import catalogue, new, scenes
from touchdown.master.verbs.reports import animate, report
from touchdown.master.verbs.studies import (
    advise,
    compare,
    compare_bearings,
    compare_modes,
    compare_rotors,
    figure,
    merge,
    stability,
    sweep,
    verdict,
)
from touchdown.master.verbs.studies.rotors import import_rotor, rotor
from touchdown.master.verbs.verb import Verb

ALL: tuple[Verb, ...] = (
    scenes.VERB,
    catalogue.VERB,
    new.VERB,
    run.VERB,
    report.VERB,
    animate.VERB,
    advise.VERB,
    sweep.VERB,
    merge.VERB,
    verdict.VERB,
    rotor.VERB,
    import_rotor.VERB,
    compare.VERB,
    compare_bearings.VERB,
    compare_rotors.VERB,
    compare_modes.VERB,
    figure.VERB,
    stability.VERB,
    build.VERB,
    ssp.VERB,
    container.VERB,
    check.VERB,
    doctor.VERB,
    cache.VERB,
)
