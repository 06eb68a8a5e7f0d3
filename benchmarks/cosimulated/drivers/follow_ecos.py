"""ecos: its one algorithm, with the package's macro step."""

from __future__ import annotations

from driver import Drop
from ecospy import EcosLib, EcosSimulation
from following import Followed, Options, main

START_VALUES = "initialValues"  # the set that a package has, which is applied where it is asked for


def follow(drop: Drop, _: Options) -> Followed:
    """One call a step."""
    EcosLib.set_log_level("warn")
    simulation = EcosSimulation(drop.step, ssp_path=str(drop.path))
    simulation.init(parameter_set=START_VALUES)
    wanted = [f"{name}::{variable}" for name, variable in drop.wanted]
    rows: list[list[float]] = []
    for _ in range(drop.steps):
        simulation.step()
        rows.append([simulation.get_real(name) for name in wanted])
    return Followed(rows, len(rows) * len(drop.components))


main(follow)
