"""The energy ledger: what crosses a connection must be the same seen from both sides.

Each side states the work of its load on its own idea of the body's motion. The bearing also states, as
`jump`, half the sum of the loads before and after times the jump of its copy at each restart. Per macro
step n the residual is

    r_n = dW_bearing(n) + dJ(n + 1) - dW_body(n)

What the body got and the bearing did not give was made by the coupling: -sum r_n. A bearing that states
nothing is listened to by a `witness`; where that cannot be, the connection is said not to be audited.

Energy alone does not say whether an answer is in doubt: a whirl turns over a thousand times what a rotor
loses by falling. So what counts is the residual over the turnover,

    sum |r_n| / (sum |F_n . dx_n| + largest kinetic energy along F_n + 0.0001 m g c)

of the worst connection, with the mean load F_n, the body's displacement dx_n, and the contract's 1/`inv_m`
as its mass: the share by which the load, along the motion, was wrong. A connection that turns over less
than a tenth of what all do is judged by that tenth. docs/coupling.md argues it.

`accounts` keeps the books, `witness` hears bearings that keep none, `judge` warns and stops, `balance` does
so for what is made inside bearings, `shortening` divides macro steps in a whirl.
"""

from __future__ import annotations

from ..loop.division import Shortening
from .accounts import Ledger
from .alarms import Balance, Judge

__all__ = ["Balance", "Judge", "Ledger", "Shortening"]
