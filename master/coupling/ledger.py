"""The energy ledger: what crosses a connection must be the same seen from both sides.

Each side states the work of its load on its own idea of the body's motion. The bearing also states, as
`jump`, half the sum of the loads before and after times the jump of its copy at each restart. Per macro
step n the residual is

    r_n = dW_bearing(n) + dJ(n + 1) - dW_body(n)

and what is reported is the sum of all |r_n| over all connections, over the scene's energy scale (the
energy lost by falling, m g c). It is a live estimate of the coupling's error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.system import System


@dataclass
class Entry:
    """One connection's account."""

    attachment: Attachment
    every: int = 1  # macro steps after which both sides have taken the same time
    last: tuple[float, float, float] = (0.0, 0.0, 0.0)  # work by the bearing, its jumps, work by the body
    pending: float = 0.0  # work difference of the last step, its jump not yet known
    total: float = 0.0  # sum of |r_n|, J
    net: float = 0.0  # sum of r_n, J


class Ledger:
    """Accounts of all connections that state work on both sides."""

    def __init__(self, system: System, scale: float) -> None:
        self.scale = scale  # J; 0: unknown, residuals are then absolute
        self.total = 0.0  # J, sum of |r_n| over all connections and steps
        self.entries = [
            Entry(a, math.lcm(system.every[a.bearing], system.every[a.body])) for a in system.attachments
        ]
        self._steps = 0
        self.follow(system)

    def follow(self, system: System) -> None:
        """Find the accounts where they now stand in the system's signals; those of the retired rest."""
        self._signals = system.signals
        self._live: list[Entry] = []
        places: list[int] = []
        for entry in self.entries:
            a = entry.attachment
            keys = (
                (a.bearing, f"{a.bearing_port}.work"),
                (a.bearing, f"{a.bearing_port}.jump"),
                (a.body, f"{a.body_port}.work"),
            )
            if all(key in system.position for key in keys):
                self._live.append(entry)
                places += [system.position[key] for key in keys]
        self._index = np.array(places, dtype=np.intp)

    def update(self) -> None:
        """Book the macro step that was just taken."""
        self._steps += 1
        values = self._signals[self._index].tolist()
        for n, entry in enumerate(self._live):
            if self._steps % entry.every:
                continue
            bearing, jump, body = values[3 * n : 3 * n + 3]
            last = entry.last
            residual = entry.pending + (jump - last[1])
            entry.total += abs(residual)
            self.total += abs(residual)
            entry.net += residual
            entry.pending = (bearing - last[0]) - (body - last[2])
            entry.last = (bearing, jump, body)

    @property
    def residual(self) -> float:
        """Sum of |r_n| over all connections and steps, over the energy scale (or in J without one)."""
        return self.total / self.scale if self.scale > 0.0 else self.total

    def worst(self) -> Entry | None:
        """The connection with the largest residual."""
        return max(self.entries, key=lambda entry: entry.total, default=None)
