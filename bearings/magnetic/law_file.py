"""A linear law from a file: state space or second-order sections, in samples or in continuous time.

    x+ = A x + B m, u = C x + D m        (x' = A x + B m in continuous time)

m: reference minus sensed position of each axis, m; or twice as many, position and reference apart: what
the rotor has moved towards the centre since the law began, then what the reference has moved from there.
u: control currents, A, or forces, N. One axis (which goes for each), both of a bearing, or those of two.

Files (docs/levitation.md) are JSON, archives of NumPy, and MATLAB's, with an array for each of the names
above, (n, n) or, at several speeds, (k, n, n); in MATLAB (n, n, k).
"""

from __future__ import annotations

import json
import math
import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import matrix_balance

from ...modelkit.archives import ARCHIVE, read_archive, refuse_large
from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import FIGURE, TEXT, Kind, Table, content_of, json_of, listed, number, text_of, word

MATLAB = ".mat"
ENDINGS = (".json", ARCHIVE, MATLAB)
STATES, AXES, SPEEDS = 48, 4, 8  # at most
GIVES = ("current", "force")
MATRICES = ("A", "B", "C", "D", "sos")
KEYS = ("title", "sample_time", "speeds", "gives", "gain", *MATRICES)
ALIASES = {"Ts": "sample_time", "dt": "sample_time"}  # as MATLAB and scipy call it
PERIOD = number("s", minimum=0.0, example="100 us")
MATRIX = Kind(lambda value, name: value, "a matrix of numbers, row by row")
RISING = listed(number("rad/s", example="9000 rpm"))
TUSTIN, MATCHED = range(2)  # methods of `Law.sampled`
UP_TO = 0.2  # of the sampling frequency, for `Law.deviation`
LINES = 200
NEAR_ZERO = 1e-9  # of a pole or zero times the sample time: an integrator's, beside rounding
NEARLY, CLOSE = 1e-2, 1e-4  # of C(s): what zeros far beyond the samples may change, and rounding
ROUNDING = 1e-15
SLOW = 0.01  # of the sampling frequency, where a matched gain is exact if not at rest


@dataclass(frozen=True, eq=False)
class Law:
    """Matrices at each of the speeds; a law is equal to itself only."""

    title: str
    sample_time: float  # s; 0: in continuous time
    speeds: np.ndarray  # (k,), rad/s, rising
    force: bool  # it gives forces
    A: np.ndarray  # (k, n, n)
    B: np.ndarray  # (k, n, inputs)
    C: np.ndarray  # (k, outputs, n)
    D: np.ndarray  # (k, outputs, inputs)

    def response(self, points: np.ndarray) -> np.ndarray:
        """C(s) or C(z) at `points` (p,): (k, p, outputs, inputs)."""
        lines = points[:, None, None] * np.eye(self.A.shape[1]) - self.A[:, None]
        return self.C[:, None] @ np.linalg.solve(lines, self.B[:, None]) + self.D[:, None]

    @property
    def stable(self) -> bool:
        """Whether it is by itself at all speeds; integrators are."""
        poles = np.linalg.eigvals(self.A)
        size = np.abs(poles)
        beyond = size - 1.0 if self.sample_time else poles.real / np.maximum(size, 1.0)
        return bool(np.all(beyond <= NEAR_ZERO))

    def sampled(self, period: float, method: int = TUSTIN, exact_at: float = 0.0) -> Law:
        """The law from sample to sample, `period` (s) apart.

        Tustin's C(z) is C(s) at `exact_at` (rad/s), that of matched poles and zeros has its size there; 0:
        at rest, where that can be. Raises TouchdownError where there is none.
        """
        if self.sample_time:
            return self
        require(
            exact_at * period < math.pi,
            f"{self.title}: exact_at = {exact_at:g} rad/s is not below half the sampling frequency",
        )
        if method == MATCHED:
            return self._matched(period, exact_at)
        t = 2.0 * math.tan(0.5 * exact_at * period) / exact_at if exact_at else period
        half = 0.5 * t * self.A
        left = np.linalg.inv(np.eye(half.shape[1]) - half)
        into = t * left @ self.B
        found = left @ (np.eye(half.shape[1]) + half), into, self.C @ left, self.D + 0.5 * self.C @ into
        return replace(self, sample_time=period, **dict(zip("ABCD", found, strict=True)))

    def _matched(self, period: float, exact_at: float) -> Law:
        """Poles and zeros at exp(s T), zeros at infinity at -1."""
        require(
            self.D.shape == (1, 1, 1),
            f"{self.title}: method = matched is for one input and one output at one speed; take tustin",
        )
        from scipy.signal import zpk2sos  # deferred: slow to import

        poles = np.linalg.eigvals(self.A[0])
        zeros, sign = self._zeros(poles, math.pi / period)
        at_rest = bool(np.all(np.abs([*poles, *zeros]) * period > NEAR_ZERO))
        w = exact_at or (0.0 if at_rest else 2.0 * math.pi * SLOW / period)
        there = self.response(np.array([1j * w]))[0, 0, 0, 0]
        z, down = np.exp(1j * w * period), np.exp(period * poles)
        up = np.concatenate((np.exp(period * zeros), np.full(len(poles) - len(zeros), -1.0 + 0.0j)))
        gain = math.copysign(abs(there * np.prod(z - down) / np.prod(z - up)), sign)
        found = _series(zpk2sos(up, down.astype(complex), gain), 1.0)
        return replace(self, sample_time=period, **{name: m[None] for name, m in found.items()})

    def _zeros(self, poles: np.ndarray, highest: float) -> tuple[np.ndarray, float]:
        """Zeros (1/s) of one input and output, and the sign of their gain.

        Where the output stays 0 the state loses a direction for each of the relative degree. Rounding takes
        infinite zeros for finite ones, far away: the fewest are taken that give C(s) within `NEARLY` up to
        `highest` (rad/s).
        """
        size, n = float(np.abs(poles).max()) or 1.0, len(poles)
        whole = np.block([[self.A[0] / size, self.B[0] / size], [self.C[0], self.D[0]]])
        whole = np.asarray(matrix_balance(whole, permute=False)[0])
        a, b, c, d = whole[:n, :n], whole[:n, n:], whole[n:, :n], whole[n:, n:]
        s = 1j * highest / size * np.geomspace(1e-4, 1.0, LINES)[:, None]
        known = self.response(size * s[:, 0])[0, :, 0, 0] * np.prod(s - poles / size, axis=1)
        found, best = (poles, 0.0), math.inf
        for _ in range(n + 1):
            if abs(d[0, 0]) > ROUNDING * np.linalg.norm(b) * np.linalg.norm(c):
                zeros = np.linalg.eigvals(a - b @ c / d)
                gains = known / np.prod(s - zeros, axis=1)
                gain = float(np.median(gains.real))
                off = float(np.abs(gains - gain).max()) / abs(gain) if gain else math.inf
                found, best = (size * zeros, gain) if off < NEARLY else found, min(best, off)
            across = np.linalg.qr(c.T, mode="complete")[0][:, 1:]
            a, b, c, d = across.T @ a @ across, across.T @ b, c @ a @ across, c @ b
        require(
            best < CLOSE,
            f"{self.title}: by method = matched rounding makes C(s) wrong by {best:.1g} of it; balance its "
            "states, or take tustin",
        )
        return found

    def deviation(self, sampled: Law) -> tuple[float, float]:
        """Largest |C(z) - C(s)| over |C(s)| up to `UP_TO` of the sampling frequency, and where (rad/s)."""
        w = 2.0 * math.pi / sampled.sample_time * np.geomspace(1e-3, 1.0, LINES) * UP_TO
        known, found = self.response(1j * w), sampled.response(np.exp(1j * w * sampled.sample_time))
        sizes = np.linalg.norm(known, 2, axis=(2, 3))
        of_all = np.linalg.norm(found - known, 2, axis=(2, 3)) / np.where(sizes > 0.0, sizes, np.inf)
        return float(of_all.max()), float(w[of_all.max(axis=0).argmax()])

    @property
    def text(self) -> str:
        """It as JSON, to the last bit."""
        matrices = {name: getattr(self, name).tolist() for name in "ABCD"}
        head = {"title": self.title, "sample_time": self.sample_time, "speeds": self.speeds.tolist()}
        return json.dumps({**head, "gives": GIVES[self.force], **matrices})


def read_law(path: Path) -> Law:
    """The law in a file. Raises TouchdownError with what is wrong, in one line."""
    ending = path.suffix.lower()
    if ending == ARCHIVE:
        return law_of(read_archive(path), str(path))
    if ending == MATLAB:
        return law_of(_of_matlab(path), str(path))
    return law_of(json_of(text_of(path, "controller"), str(path)), str(path))


def law_of(data: Mapping[str, Any], file: str) -> Law:
    """The law that a file's names say. Raises TouchdownError."""
    values = {ALIASES.get(name, name): _plain(name, value) for name, value in data.items()}
    t = Table(f"{file}: ", values)
    t.only(KEYS)
    speeds = t.get("speeds", RISING, (0.0,))
    t.require(
        0 < len(speeds) <= SPEEDS and all(a < b for a, b in pairwise(speeds)),
        "speeds",
        f"must be rising, and at most {SPEEDS}",
    )
    if "sos" in values:
        t.require(values.keys().isdisjoint("ABCD"), "sos", "stands beside A, B, C or D; give one of them")
        matrices = _of_sections(t)
    else:
        matrices = _of_matrices(t)
    k, n = len(speeds), matrices["A"].shape[-1]
    for name, matrix in matrices.items():
        t.require(matrix.ndim == 2 or len(matrix) == k, name, f"is not of as many speeds as `speeds`, {k}")
    require(0 < n <= STATES, f"{file}: has {n} states, and may have 1 to {STATES}; reduce it")
    whole = {name: np.array(np.broadcast_to(m, (k, *m.shape[-2:]))) for name, m in matrices.items()}
    force = t.get("gives", word(GIVES), GIVES[0]) == GIVES[1]
    title, period = t.get("title", TEXT, Path(file).name), t.get("sample_time", PERIOD, 0.0)
    return Law(title, period, np.array(speeds), force, **whole)


def _of_sections(t: Table) -> dict[str, np.ndarray]:
    """A, B, C, D of second-order sections b0 b1 b2 a0 a1 a2, in powers of 1/z, or falling ones of s."""
    sos = _numbers(t, "sos")
    t.require(sos.ndim == 2 and sos.shape[1] == 6, "sos", "must be rows of six: b0 b1 b2 a0 a1 a2")
    for row in sos:
        first = np.flatnonzero(row[3:])
        proper = len(first) and not np.any(row[: first[0]])
        t.require(proper, "sos", f"has a section without a proper denominator, {row.tolist()}")
    return _series(sos, t.get("gain", FIGURE, 1.0))


def _series(sos: np.ndarray, gain: float) -> dict[str, np.ndarray]:
    """A, B, C, D of sections behind each other, each in the transposed direct form."""
    a, b, c, d = np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.array([[gain]])
    for row in sos:
        first = int(np.flatnonzero(row[3:])[0])
        up, down = row[first:3] / row[3 + first], row[3 + first :] / row[3 + first]
        while len(down) > 1 and up[-1] == down[-1] == 0.0:  # of first order, in powers of 1/z
            up, down = up[:-1], down[:-1]
        n = len(down) - 1
        own, into = np.eye(n, k=1), (up[1:] - down[1:] * up[0])[:, None]
        own[:, :1] = -down[1:, None]
        a = np.block([[a, np.zeros((len(a), n))], [into @ c, own]])
        b, c, d = np.vstack((b, into @ d)), np.hstack((up[0] * c, np.eye(1, n))), up[0] * d
    return {"A": a, "B": b, "C": c, "D": d}


def _of_matrices(t: Table) -> dict[str, np.ndarray]:
    """A, B, C, D, each of one speed or of several."""
    states = not t.values.keys().isdisjoint("ABC")
    found = {name: _numbers(t, name) for name in "ABCD" if (states and name != "D") or name in t.values}
    require(found, f"{t.where}has neither A, B, C and D, nor sos")
    outputs, inputs = (found["C"].shape[-2], found["B"].shape[-1]) if states else found["D"].shape[-2:]
    n = found["A"].shape[-1] if states else 1
    shapes = {"A": (n, n), "B": (n, inputs), "C": (outputs, n), "D": (outputs, inputs)}
    for name, shape in shapes.items():
        there = found.setdefault(name, np.zeros(shape)).shape[-2:]
        require(
            there == shape,
            f"{t.where}{name} is {there[0]} by {there[1]}; beside the others it must be "
            f"{shape[0]} by {shape[1]}",
        )
    require(
        outputs in (1, 2, AXES) and inputs in (outputs, 2 * outputs),
        f"{t.where}has {inputs} inputs and {outputs} outputs; there may be 1, 2 (axes of a bearing) or "
        f"{AXES} (of two bearings) of both, or twice as many inputs",
    )
    return found


def _numbers(t: Table, name: str) -> np.ndarray:
    """Finite real numbers (rows, columns), or (speeds, rows, columns)."""
    try:
        found = np.asarray(t.get(name, MATRIX))
        if found.dtype.kind not in "iuf" or found.ndim not in (2, 3) or not all(found.shape[-2:]):
            raise ValueError
    except ValueError:
        raise t.error(name, f"must be {MATRIX.meant}") from None
    found = found.astype(float)
    t.require(np.all(np.isfinite(found)), name, "holds what is not a finite number")
    return found


def _plain(name: str, value: Any) -> Any:
    """A single value or a row of an archive, as JSON has it."""
    if not isinstance(value, np.ndarray) or name in MATRICES:
        return value
    return np.ravel(value).tolist() if name == "speeds" or value.size != 1 else value.item()


def _of_matlab(path: Path) -> dict[str, Any]:
    """The arrays of a MATLAB file by name."""
    from scipy.io import loadmat, whosmat
    from scipy.io.matlab import MatReadError

    content = BytesIO(content_of(path, str(path)))
    names = (*KEYS, *ALIASES)
    try:
        sizes = [math.prod(shape) for name, shape, _ in whosmat(content) if name in names]
        refuse_large(8 * sum(sizes), f"{path} would fill")
        content.seek(0)
        found = loadmat(content, variable_names=names)
    except NotImplementedError:
        raise TouchdownError(f"{path} is of MATLAB 7.3; save it with -v7") from None
    except (
        *(MatReadError, ValueError, TypeError, KeyError, IndexError, EOFError, OverflowError, MemoryError),
        *(OSError, struct.error, zlib.error),
    ) as error:
        raise TouchdownError(f"{path} is damaged or not MATLAB's ({error}); save it again") from None
    arrays = {name: np.asarray(value) for name, value in found.items() if name in names}
    return {name: np.moveaxis(a, -1, 0) if a.ndim == 3 else a for name, a in arrays.items()}
