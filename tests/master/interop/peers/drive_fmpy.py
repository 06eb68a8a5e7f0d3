"""A drop in fmpy's SSP runner.

The runner reads connectors only, so what is wanted becomes one. It leaves out a package's parameters, so
they travel as its argument, start values of inputs among them; it hands 0 to every input in the first step.
"""

from __future__ import annotations

import tempfile
import zipfile
from pathlib import Path
from xml.etree.ElementTree import SubElement, tostring

from driver import HEART, SSC, SSD, WARM_UP, Answer, Drop, Watch, main, values
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import Parameter, ParameterSet


def drive(drop: Drop) -> Answer:
    """The runner keeps no time of its own: two runs of different length give the steps' cost."""
    given = [
        Parameter(name=f"{name}.{variable}", type="Real", value=value)
        for name, component in drop.components.items()
        for variable, value in values(component).items()
    ]
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder) / "system.ssp"
        write_readable(drop, package)

        def run(steps: int):
            watch = Watch()
            end = (steps - 0.5) * drop.step  # rows bear the time before their step
            rows = simulate_ssp(
                str(package),
                stop_time=end,
                step_size=drop.step,
                parameter_set=ParameterSet(name="values", parameters=given),
            )
            assert len(rows) == steps
            return rows[-1], watch.read()

        run(1)  # compiled kernels are loaded
        _, short = run(WARM_UP)
        last, long = run(drop.steps)
    spent = long[0] - short[0], long[1] - short[1]
    return Answer([float(last[".".join(wanted)]) for wanted in drop.wanted], spent)


def write_readable(drop: Drop, target: Path) -> None:
    """The drop's package with connectors for what is wanted."""
    for name, variable in drop.wanted:
        connectors = drop.components[name].find(f"{SSD}Connectors")
        if connectors.find(f"{SSD}Connector[@name='{variable}']") is None:
            connector = SubElement(connectors, f"{SSD}Connector", {"name": variable, "kind": "output"})
            SubElement(connector, f"{SSC}Real")
    with zipfile.ZipFile(drop.path) as source, zipfile.ZipFile(target, "w") as archive:
        for name in source.namelist():
            archive.writestr(name, tostring(drop.root) if name == HEART else source.read(name))


main(drive)
