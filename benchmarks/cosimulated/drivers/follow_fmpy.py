"""fmpy's SSP runner. It reads no values of a package, so it is handed them as its parameter set."""

from __future__ import annotations

import tempfile
from pathlib import Path

from drive_fmpy import readable
from driver import Drop, values
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import Parameter, ParameterSet
from following import Followed, Options, main


def follow(drop: Drop, _: Options) -> Followed:
    """The tool records its connectors by itself."""
    given = [
        Parameter(name=f"{name}.{variable}", value=value)
        for name, component in drop.components.items()
        for variable, value in values(component).items()
    ]
    with tempfile.TemporaryDirectory() as folder:
        rows = simulate_ssp(
            str(readable(drop, Path(folder))),
            stop_time=(drop.steps - 0.5) * drop.step,
            step_size=drop.step,
            parameter_set=ParameterSet(parameters=given),
        )
    wanted = [".".join(names) for names in drop.wanted]
    return Followed(
        [[float(row[name]) for name in wanted] for row in rows], len(rows) * len(drop.components)
    )


main(follow)
