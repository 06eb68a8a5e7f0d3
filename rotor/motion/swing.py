"""Each mode alone, for a stride: an oscillator under a load linear in time, exactly."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.numerics import oscillator
from touchdown.modelkit.variables import array, real
from touchdown.rotor.modal.data import MOST_MODES
from touchdown.rotor.motion.state import ANGLE, SPIN, modal, rest
from touchdown.rotor.motion.unbalance import unbalance_of

SLOW = 1e-4  # (omega h)^2 of a stride; below, Hermite's rule errs by 1e-11, and the exact form cancels


@dataclass(frozen=True)
class Stride:
    """`oscillator.Step` of every mode, for one length."""

    length: float = real(0.0, "s", "of the stride")
    zz: np.ndarray = array(MOST_MODES)
    zv: np.ndarray = array(MOST_MODES)
    vz: np.ndarray = array(MOST_MODES)
    vv: np.ndarray = array(MOST_MODES)
    zf: np.ndarray = array(MOST_MODES)
    vf: np.ndarray = array(MOST_MODES)
    zg: np.ndarray = array(MOST_MODES)
    vg: np.ndarray = array(MOST_MODES)


class LinearLoad(NamedTuple):
    """Modal forces f + df s, s (s) after the middle of the macro step; (n,) each, N/kg^0.5 and per s."""

    fx: np.ndarray
    fy: np.ndarray
    dfx: np.ndarray
    dfy: np.ndarray


class Swung(NamedTuple):
    """One mode in one plane at the end of a stride, and what it gathered."""

    p: float  # m kg^0.5
    v: float  # m kg^0.5/s
    area: float  # int p dt
    heat: float  # int 2 zeta omega v^2 dt, J


@kernel
def prepare_stride(m, h):
    """Set m.s.stride to every mode's exact stride of h (s), unless it is so already."""
    stride = m.s.stride
    if stride.length == h:
        return
    for k in range(m.d.modes):
        s = oscillator.step(m.d.stiffness[k], m.d.damping[k], h)
        stride.zz[k], stride.zv[k], stride.vz[k], stride.vv[k] = s.zz, s.zv, s.vz, s.vv
        stride.zf[k], stride.vf[k], stride.zg[k], stride.vg[k] = s.zf, s.vf, s.zg, s.vg
    stride.length = h


@kernel
def swing(q, m, load, since_middle, h, alpha, area):
    """Each mode of q (N,) alone for h (s) about `since_middle` (s), under a `LinearLoad` and unbalance.

    alpha: spin acceleration (rad/s2). Adds int p dt to `area` (`Planar`); returns the heat (J).
    """
    px, py, vx, vy = modal(q, m)
    area_x, area_y = area
    spin, angle = rest(q, m)[SPIN], rest(q, m)[ANGLE] + m.p.unbalance_angle
    angle_end = angle + h * (spin + 0.5 * alpha * h)
    cosine, sine = math.cos(angle), math.sin(angle)
    cosine_end, sine_end = math.cos(angle_end), math.sin(angle_end)
    square, square_end = spin * spin, (spin + alpha * h) ** 2
    lost = 0.0
    for k in range(m.d.modes):
        fx, fy = load.fx[k] + load.dfx[k] * since_middle, load.fy[k] + load.dfy[k] * since_middle
        dfx, dfy = load.dfx[k], load.dfy[k]
        if m.d.unbalance.present:
            ux, uy = _pull(m, k, cosine, sine, square, alpha)
            ux_end, uy_end = _pull(m, k, cosine_end, sine_end, square_end, alpha)
            fx, fy = fx + 0.5 * (ux + ux_end), fy + 0.5 * (uy + uy_end)
            dfx, dfy = dfx + (ux_end - ux) / h, dfy + (uy_end - uy) / h
        in_x = _along(m, k, h, px[k], vx[k], fx, dfx)
        in_y = _along(m, k, h, py[k], vy[k], fy, dfy)
        px[k], vx[k], py[k], vy[k] = in_x.p, in_x.v, in_y.p, in_y.v
        area_x[k] += in_x.area
        area_y[k] += in_y.area
        lost += in_x.heat + in_y.heat
    return lost


@kernel
def _pull(m, k, cosine, sine, square, alpha):
    """Modal force (x, y) of the unbalance: (square - i alpha) U exp(i theta), square that of the spin."""
    ux, uy = unbalance_of(m, k, cosine, sine)
    return square * ux + alpha * uy, square * uy - alpha * ux


@kernel
def _along(m, k, h, p, v, f, df):
    """`Swung` of mode k over a stride of h (s) under the load f + df (t - h/2), from p and v.

    The area follows from the equation of motion, the heat is the work of the load less the energy gained.
    """
    s, damping, stiffness = m.s.stride, m.d.damping[k], m.d.stiffness[k]
    p_end = s.zz[k] * p + s.zv[k] * v + s.zf[k] * f + s.zg[k] * df
    v_end = s.vz[k] * p + s.vv[k] * v + s.vf[k] * f + s.vg[k] * df
    if stiffness * h * h < SLOW:
        area = 0.5 * h * (p + p_end) + h * h / 12.0 * (v - v_end)
    else:
        area = (f * h - (v_end - v) - damping * (p_end - p)) / stiffness
    heat = 0.0
    if damping > 0.0:
        heat = f * (p_end - p) + df * (0.5 * h * (p_end + p) - area)
        heat -= 0.5 * ((v_end - v) * (v_end + v) + stiffness * (p_end - p) * (p_end + p))
    return Swung(p_end, v_end, area, heat)
