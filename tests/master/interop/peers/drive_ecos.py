"""A drop in ecos; the package, as `touchdown ssp --outputs-only` writes it, goes in whole."""

from __future__ import annotations

from driver import WARM_UP, Answer, Drop, Watch, main
from ecospy import EcosLib, EcosSimulation


def drive(drop: Drop) -> Answer:
    """The macro step is an argument: ecos does not read the package's. Nor is it told to set anything."""
    EcosLib.set_log_level("warn")
    simulation = EcosSimulation(drop.step, ssp_path=str(drop.path))
    simulation.init()
    simulation.step(WARM_UP)
    watch = Watch()
    simulation.step(drop.steps - WARM_UP)
    spent = watch.read()
    return Answer([simulation.get_real(f"{name}::{wanted}") for name, wanted in drop.wanted], spent)


main(drive)
