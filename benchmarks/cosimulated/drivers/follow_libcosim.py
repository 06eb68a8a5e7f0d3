"""libcosim: its fixed macro step, or with the option `ecco` its energy-based step control.

The step control is not to be had for a package: the system is built call by call from the package's
content, with the power bonds of the option `bonds`, each (component, output, input) twice.
"""

from __future__ import annotations

import tempfile
import zipfile

from driver import Drop, values
from following import Followed, Options, main
from libcosimpy.CosimAlgorithm import CosimAlgorithm, EccoParams
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

NANO = 1e9  # ticks of libcosim's clock in 1 s


def follow(drop: Drop, options: Options) -> Followed:
    """One call a step; with step control until the tool's clock is at the end."""
    log_output_level(CosimLogLevel.ERROR)
    controlled = "ecco" in options
    execution = controlled_execution(drop, options) if controlled else fixed_execution(drop)
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    slaves = {slave.name.decode(): slave.index for slave in execution.slave_infos()}
    references = {name: variables(execution, index) for name, index in slaves.items()}
    rows: list[list[float]] = []
    while (
        execution.status().current_time < NANO * drop.step * drop.steps - 0.5
        if controlled
        else len(rows) < drop.steps
    ):
        if not execution.step():
            raise RuntimeError(f"the step from {execution.status().current_time / NANO:g} s fails")
        rows.append([
            observer.last_real_values(slaves[name], [references[name][variable]])[0]
            for name, variable in drop.wanted
        ])  # fmt: skip
    return Followed(rows, len(rows) * len(slaves))


def fixed_execution(drop: Drop) -> CosimExecution:
    """The package as it is, with its macro step."""
    return CosimExecution.from_ssp_file(str(drop.path))


def controlled_execution(drop: Drop, options: Options) -> CosimExecution:
    """The package's content under step control."""
    algorithm = CosimAlgorithm.create_ecco_algorithm(EccoParams(**options["ecco"]))
    execution = CosimExecution.from_algorithm(algorithm)
    execution.algorithm = algorithm  # as long as it is needed
    folder = tempfile.mkdtemp(dir=drop.path.parent)
    with zipfile.ZipFile(drop.path) as archive:
        archive.extractall(folder)
    slaves, references = {}, {}
    for name, component in drop.components.items():
        index = execution.add_local_slave(CosimLocalSlave(f"{folder}/{component.attrib['source']}", name))
        slaves[name], references[name] = index, variables(execution, index)
        for variable, value in values(component).items():
            start = (
                execution.real_initial_value
                if isinstance(value, float)
                else execution.integer_initial_value
            )
            assert start(index, references[name][variable], value)

    def ends(name: str, *names: str) -> list[int]:
        return [slaves[name], *(references[name][variable] for variable in names)]

    for source, output, target, given in drop.connections:
        assert execution.connect_real_variables(*ends(source, output), *ends(target, given)) >= 0
    for one, other in options["bonds"]:
        assert algorithm.add_power_bond(*ends(*one), *ends(*other)) >= 0
    return execution


def variables(execution: CosimExecution, index: int) -> dict[str, int]:
    """The references of an FMU's variables."""
    return {v.name.decode(): v.reference for v in execution.slave_variables(index)}


main(follow)
