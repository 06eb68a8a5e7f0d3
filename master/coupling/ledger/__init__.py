"""The energy ledger: the work that crosses a connection must be the same seen from both sides.

Each side states the work of its load on its own idea of the body's motion. The bearing also states, as
`jump`, half the sum of the loads before and after times the jump of its copy at each restart. Per macro
step n the residual is

    r_n = dW_bearing(n) + dJ(n + 1) - dW_body(n)

Energy that the body got and the bearing did not give was made by the coupling: -sum r_n. For a bearing that
states nothing, an auditor measures both works; where that cannot be, the connection is reported as not
audited.

Energy alone does not say whether an answer is in doubt: a whirl turns over a thousand times what a rotor
loses by falling. So what counts is by how much a force would be off to make the residual,

    0.5 sum |r_n| / max(2 K, 0.2 (sum |F_n . dx_n| + K))

of the worst connection, with the mean load F_n, the body's displacement dx_n, and the largest kinetic
energy K along F_n at the bearing, the contract's 1/`inv_m` as its mass. Of a housing that a bearing carries
by its own equations only what sets the bearing's copy back counts. docs/coupling.md argues it.

`accounts` keeps the books, one `account` for each connection; `auditor` measures the work of bearings that
state none; `alarms` warns and stops, for connections and for the energy inside bearings and of the whole
system. Macro steps in a whirl are divided by `WhirlStepControl` in `master.coupling.loop.division`.
"""

from __future__ import annotations

from ..loop.division import WhirlStepControl
from .accounts import Ledger
from .alarms import EnergyBalanceMonitor, MountSwing, ResidualMonitor

__all__ = ["EnergyBalanceMonitor", "Ledger", "MountSwing", "ResidualMonitor", "WhirlStepControl"]
