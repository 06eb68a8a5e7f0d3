"""The verbs of the command `touchdown`, one module each; `ALL` is in the order of its help."""

from __future__ import annotations

from touchdown.master.verbs import run, scenes
from touchdown.master.verbs.fmus import build, check, container, doctor, ssp
from touchdown.master.verbs.studies import (
    advise,
    compare,
    compare_bearings,
    compare_modes,
    compare_rotors,
    rotor,
    stability,
    sweep,
)

ALL = tuple(
    module.VERB
    for module in (
        *(scenes, run, advise, sweep, rotor),
        *(compare, compare_bearings, compare_rotors, compare_modes, stability),
        *(build, ssp, container, check, doctor),
    )
)
