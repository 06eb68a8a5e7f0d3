"""Plant and controllers of sampled loops as state spaces, and their answers over the frequency.

The plant's inputs are the axes' control currents (A), its outputs the sensors' signals (m). A controller
designed for the sampled plant, whose inputs act late as the present controllers' do, comes back as a
[component](../../docs/levitation.md). All answers are those at the samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.text import HZ
from .linear_loops import Loops, Sampled, StateSpace

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Answers:
    """Of each axis over the frequency, complex, (n, axes)."""

    omega: np.ndarray  # (n,), rad/s
    axes: tuple[str, ...]
    values: Mapping[str, np.ndarray]  # by the names of `UNITS`

    def to_pandas(self) -> pandas.DataFrame:
        """Real and imaginary part of each, over the frequency (Hz)."""
        import pandas

        columns = {
            f"{part}({name}) [{UNITS[name]}] {axis}": take(values[:, k])
            for name, values in self.values.items()
            for k, axis in enumerate(self.axes)
            for part, take in (("Re", np.real), ("Im", np.imag))
        }
        return pandas.DataFrame(columns, index=pandas.Index(HZ * self.omega, name="frequency [Hz]"))


UNITS = {  # of an axis: name, unit
    "L": "1",  # the loop's gain, the others closed
    "S": "1",  # sensitivity at its sensor, all closed
    "P": "m/A",  # its sensor's signal over its control current, all open
    "C": "A/m",  # its control current over its sensor's deviation
    "G": "m/N",  # compliance: the journal's displacement over a force there, all closed
}


def controlled(loops: Loops) -> Sampled:
    """Loops that have control currents. Raises TouchdownError of magnetic bearings without a controller."""
    if not isinstance(loops, Sampled):
        raise TouchdownError(
            "magnetic bearings with a law of their own have no control currents; take amb_actuator"
        )
    return loops


def plant(loops: Sampled, speed: float, sampled: bool) -> StateSpace:
    """At a speed (rad/s): x' = A x + B u, or from sample to sample, u as late as in the loops."""
    (a, b, soon), c = loops.plant(speed, sampled)
    n, m, delay = len(a), len(loops.names), loops.laws.delay if sampled else 0
    whole = np.zeros((n + m * delay, n + m * delay))  # the plant, then set points that wait, oldest first
    into, seen = np.zeros((len(whole), m)), np.zeros((m, len(whole)))
    whole[:n, :n], seen[:, :n] = a, c
    if delay:
        whole[:n, n : n + m], into[-m:] = b, np.eye(m)
        whole[n:-m, n + m :] = np.eye(m * (delay - 1))
        if soon is not None and delay == 1:
            into[:n] = soon
        elif soon is not None:
            whole[:n, n + m : n + 2 * m] = soon
    else:
        into[:n] = b
    return StateSpace(whole, into, seen, np.zeros((m, m)))


def answers(loops: Sampled, speed: float, omega: np.ndarray) -> Answers:
    """Of stable loops at a speed (rad/s) and angular frequencies (n,), rad/s."""
    model = plant(loops, speed, sampled=True)
    z, journals, places = np.exp(1j * omega * loops.period), loops.journal_axes, loops.rotor.places
    s = _axes(loops.closed(speed).balanced().sensitivity(omega))
    swings = np.array([journals @ loops.swing(speed, w, journals.T)[:places] for w in omega])
    values = {"L": 1.0 / s - 1.0, "S": s, "P": model.answer(z), "C": loops.law.answer(z), "G": swings}
    return Answers(omega, loops.names, {name: _axes(each) for name, each in values.items()})


def _axes(values: np.ndarray) -> np.ndarray:
    """Of matrices (n, axes, axes), each axis by itself (n, axes)."""
    return values if values.ndim == 2 else np.diagonal(values, axis1=1, axis2=2)
