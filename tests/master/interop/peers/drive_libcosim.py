"""A drop in libcosim; the package, as `touchdown ssp --outputs-only` writes it, goes in whole."""

from __future__ import annotations

from driver import WARM_UP, Answer, Drop, Watch, main
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver


def drive(drop: Drop) -> Answer:
    """The macro step is the package's own."""
    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_ssp_file(str(drop.path))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    assert execution.step(WARM_UP)
    watch = Watch()
    assert execution.step(drop.steps - WARM_UP)
    spent = watch.read()
    slaves = {slave.name.decode(): slave.index for slave in execution.slave_infos()}
    found = []
    for name, wanted in drop.wanted:
        index = slaves[name]
        variables = {v.name.decode(): v.reference for v in execution.slave_variables(index)}
        found += observer.last_real_values(index, [variables[wanted]])
    return Answer(found, spent)


main(drive)
