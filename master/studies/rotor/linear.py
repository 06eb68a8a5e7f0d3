"""What a bearing on the rig answers to small swings, and the linear law that is nearest to it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.master.studies.rotor.rig import NO_FORCE, Rig
from touchdown.rotor.modal.whirl import dynamic_stiffness

AMPLITUDE = 1e-6  # m
NO_LAG = 1e-7  # s; a lag this short is none
PLAIN = 1e-3  # misfit of a law without a lag that needs none
ROUNDING = 1e-6  # of the stiffness, what measuring may add


@dataclass(frozen=True)
class Response:
    """Dynamic stiffness of a bearing by frequency."""

    frequencies: np.ndarray  # (F,), Hz
    stiffness: np.ndarray  # (F, 2, 2), complex, N/m; rows: the force's directions, columns: the motion's

    @property
    def real(self) -> np.ndarray:
        """Stiffness in each direction by frequency (F, 2), N/m."""
        return np.real(np.diagonal(self.stiffness, axis1=1, axis2=2))

    @property
    def damping(self) -> np.ndarray:
        """Damping in each direction by frequency (F, 2), N s/m."""
        return np.imag(np.diagonal(self.stiffness, axis1=1, axis2=2)) / (
            2.0 * math.pi * self.frequencies[:, None]
        )


@dataclass(frozen=True)
class Law:
    """(1 + lag s) force = -(stiffness + damping s) motion, fitted to a response."""

    stiffness: np.ndarray  # (2, 2), N/m
    damping: np.ndarray  # (2, 2), N s/m
    lag: float  # s
    misfit: float  # the largest deviation, over the largest dynamic stiffness


@dataclass(frozen=True)
class Answer:
    """What of a bearing's force follows one motion."""

    sensed: bool  # the motion that its sensors see; else the journal's
    response: Response
    law: Law


def answers(rig: Rig, sensors: bool) -> tuple[Answer, ...]:
    """A bearing's answers to swings about its place: of its journal, of its sensors; none without a force.

    sensors: whether it has any beside the journal. By its sensors is what it answers beyond its answer to
    the journal alone.
    """
    whole = _response(rig, True)
    if whole is None:
        return ()
    if not sensors:
        return (_answer(False, whole),)
    alone = _response(rig, False)
    if alone is None:
        return (_answer(True, whole),)
    rest = Response(whole.frequencies, whole.stiffness - alone.stiffness)
    size, by_journal, by_sensor = (np.max(np.abs(r.stiffness), axis=(1, 2)) for r in (whole, alone, rest))
    if np.all(by_journal <= ROUNDING * size):
        return (_answer(True, whole),)
    if np.all(by_sensor <= (rig.sagitta() + ROUNDING) * size):
        return (_answer(False, whole),)
    return _answer(False, alone), _answer(True, rest)


def _answer(sensed: bool, found: Response) -> Answer:
    return Answer(sensed, found, fitted(found))


def _response(rig: Rig, sensed: bool) -> Response | None:
    """What a bearing answers to swings that its sensors see or do not; None where it gives no force."""
    frequencies = rig.frequencies
    columns = np.empty((len(frequencies), 2, 2), complex)  # frequency, motion, force
    for k in reversed(range(len(frequencies))):  # a short swing says whether there is a force
        columns[k] = [
            rig.dynamic_stiffness(frequencies[k], axis, AMPLITUDE, sensed=sensed) for axis in np.eye(2)
        ]
        if AMPLITUDE * np.max(np.abs(columns[k])) <= NO_FORCE:
            return None
    return Response(frequencies, columns.transpose(0, 2, 1))


def fitted(found: Response) -> Law:
    """The law nearest to a response, every frequency weighing as much; with a lag only if one is there."""
    plain = _least_squares(found, False)
    if plain.misfit <= PLAIN:
        return plain
    law = _least_squares(found, True)
    return law if law.lag > NO_LAG else plain


def _least_squares(found: Response, lags: bool) -> Law:
    """D (1 + i w lag) = K + i w C is linear in K, C and lag."""
    rate = 2.0 * math.pi * found.frequencies
    weight = 1.0 / np.max(np.abs(found.stiffness), axis=(1, 2))
    rows, right = [], []
    for D, w, by in zip(found.stiffness.reshape(-1, 4), rate, weight, strict=True):
        for entry in range(4):
            row = np.zeros(9, complex)
            row[entry], row[4 + entry] = by, 1j * w * by
            row[8] = -1j * w * D[entry] * by if lags else 0.0
            rows.append(row)
            right.append(D[entry] * by)
    system, sides = np.array(rows), np.array(right)
    scale = np.linalg.norm(system, axis=0)
    scale[scale == 0.0] = 1.0
    found_by = np.linalg.lstsq(_split(system) / scale, _split(sides))[0]
    values = found_by / scale
    K, C, lag = values[:4].reshape(2, 2), values[4:8].reshape(2, 2), float(values[8])
    told = dynamic_stiffness(K, C, lag, rate[:, None, None])
    most = np.max(np.abs(found.stiffness))
    misfit = np.max(np.abs(told - found.stiffness)) / most
    return Law(_cleared(K, most), _cleared(C, most / np.max(rate)), lag, float(misfit))


def _split(values: np.ndarray) -> np.ndarray:
    """Real parts, and below them imaginary ones."""
    return np.concatenate((np.real(values), np.imag(values)))


def _cleared(matrix: np.ndarray, measured: float) -> np.ndarray:
    """Without what measuring adds: directions that are alike are made equal, what is none goes.

    measured: the largest that was, in the unit of `matrix`.
    """
    size = max(measured, np.max(np.abs(matrix)))
    cleared = np.where(np.abs(matrix) > ROUNDING * size, matrix, 0.0)
    if abs(cleared[0, 0] - cleared[1, 1]) <= ROUNDING * size:
        cleared[0, 0] = cleared[1, 1] = 0.5 * (cleared[0, 0] + cleared[1, 1])
    return cleared
