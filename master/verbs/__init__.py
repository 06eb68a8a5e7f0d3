"""The verbs of the command `touchdown`, one module each; `ALL` in the order of its help."""

from __future__ import annotations

from master.verbs import (
    advise,
    build,
    check,
    compare,
    compare_bearings,
    compare_modes,
    compare_rotors,
    container,
    doctor,
    rotor,
    run,
    scenes,
    ssp,
    stability,
    sweep,
)

ALL = (
    scenes,
    run,
    advise,
    sweep,
    rotor,
    compare,
    compare_bearings,
    compare_rotors,
    compare_modes,
    stability,
    build,
    ssp,
    container,
    check,
    doctor,
)
