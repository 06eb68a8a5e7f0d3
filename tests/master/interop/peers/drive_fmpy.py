"""A drop in fmpy's SSP runner; the package, as `touchdown ssp --outputs-only` writes it, goes in whole.

The runner reads connectors only: what is wanted and is none becomes one, in a copy. It leaves out a
package's values, which the FMUs start from by themselves; it hands 0 to every connected input in the first
step.
"""

from __future__ import annotations

import tempfile
import zipfile
from pathlib import Path
from xml.etree.ElementTree import SubElement, tostring

from driver import HEART, SSC, SSD, WARM_UP, Answer, Drop, Watch, main
from fmpy.ssp.simulation import simulate_ssp


def drive(drop: Drop) -> Answer:
    """The runner keeps no time of its own: two runs of different length give the steps' cost."""
    with tempfile.TemporaryDirectory() as folder:
        package = readable(drop, Path(folder))

        def run(steps: int):
            watch = Watch()
            end = (steps - 0.5) * drop.step  # rows bear the time before their step
            rows = simulate_ssp(str(package), stop_time=end, step_size=drop.step)
            assert len(rows) == steps
            return rows[-1], watch.read()

        run(1)  # compiled kernels are loaded
        _, short = run(WARM_UP)
        last, long = run(drop.steps)
    spent = long[0] - short[0], long[1] - short[1]
    return Answer([float(last[".".join(wanted)]) for wanted in drop.wanted], spent)


def readable(drop: Drop, folder: Path) -> Path:
    """The drop's package where all that is wanted is a connector, else a copy in which it is."""
    hidden = [(name, variable) for name, variable in drop.wanted if not connected(drop, name, variable)]
    if not hidden:
        return drop.path
    for name, variable in hidden:
        connectors = drop.components[name].find(f"{SSD}Connectors")
        connector = SubElement(connectors, f"{SSD}Connector", {"name": variable, "kind": "output"})
        SubElement(connector, f"{SSC}Real")
    target = folder / "system.ssp"
    with zipfile.ZipFile(drop.path) as source, zipfile.ZipFile(target, "w") as archive:
        for name in source.namelist():
            archive.writestr(name, tostring(drop.root) if name == HEART else source.read(name))
    return target


def connected(drop: Drop, name: str, variable: str) -> bool:
    """Whether it is a connector of the package."""
    return drop.components[name].find(f"{SSD}Connectors/{SSD}Connector[@name='{variable}']") is not None


if __name__ == "__main__":
    main(drive)
