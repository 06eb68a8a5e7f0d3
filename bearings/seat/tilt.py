"""The journal copy's tilt, and what is made of the moments that tilt it.

    rx'' = alpha_x_free + inv_I_t Mx - inv_mI Fy        ry'' = alpha_y_free + inv_I_t My + inv_mI Fx

as `copies` has it for the journal's place, which the moments move by the same inv_mI; the elastic modes
that are carried pull the tilt back as they pull the journal. The gyroscopic acceleration is part of
`alpha_*_free`, as it was at the restart; what it changes by follows from `gyro` (`gyroscopic`). The housing
does not tilt. Where nothing is stated of a tilt and no moment acts, all of it stays 0.
"""

from __future__ import annotations

from ...modelkit.kernel import inlined, kernel
from ...modelkit.ports import MODEL
from .along import BEHIND_ALONG

JRX, JRY, JWX, JWY = range(BEHIND_ALONG, BEHIND_ALONG + 4)  # journal copy
JPMX, JPMY, JQMX, JQMY = range(BEHIND_ALONG + 4, BEHIND_ALONG + 8)  # impulse, first moment of the moments
INSIDE = BEHIND_ALONG + 8  # first component of what is inside the bearing

TILT_SCALE = 1e-4  # rad; an indentation over a centimetre or so
TILT_RATE_SCALE = 1.0  # rad/s; a landing's velocity over as much
MOMENT_IMPULSE_SCALE = 1e-3  # N m s; a landing's impulse over as much


@kernel
def take_tilt(q, m):
    """Set the copy's tilt in q to the journal's in m.u."""
    j = m.u.journal
    q[JRX], q[JRY], q[JWX], q[JWY] = j.rx, j.ry, j.wx, j.wy


@kernel
def clear_tilt(q):
    """Clear what the state q gathers of the moments over a macro step."""
    q[JPMX], q[JPMY], q[JQMX], q[JQMY] = 0.0, 0.0, 0.0, 0.0


@kernel
def tilt_rates(s, q, dq, m, load, own, moves, speeds_up):
    """Derivatives dq of the copy's tilt and its quadratures, arguments as of `along.along_rates`."""
    j = m.u.journal
    dq[JRX], dq[JRY] = moves * q[JWX], moves * q[JWY]
    dq[JWX] = speeds_up * (j.alpha_x_free + j.inv_I_t * own.jmx - j.inv_mI * own.jy)
    dq[JWY] = speeds_up * (j.alpha_y_free + j.inv_I_t * own.jmy + j.inv_mI * own.jx)
    dq[JPMX], dq[JPMY] = load.jmx, load.jmy
    dq[JQMX], dq[JQMY] = s * load.jmx, s * load.jmy


@kernel
def gyroscopic(q, m):
    """The change of the gyroscopic accelerations since the restart.

    Of the tilt about x and y (rad/s2), and of the seat along x and y (m/s2), which is off the centre of
    mass by inv_mI/inv_I_t (m). None of a tilt that is prescribed.
    """
    j = m.u.journal
    if j.gyro == 0.0 or j.inv_I_t == 0.0 or m.p.interface.order < MODEL:
        return 0.0, 0.0, 0.0, 0.0
    about_x, about_y = -j.gyro * (q[JWY] - j.wy), j.gyro * (q[JWX] - j.wx)
    lever = j.inv_mI / j.inv_I_t
    return about_x, about_y, lever * about_y, -lever * about_x


@inlined
def drift_tilt(trial, q, mid, h, moves):
    """The copy's tilt in the state `trial`, as `copies.drift` has the positions; h: s."""
    trial[JRX] = q[JRX] + moves * h * mid[JWX]
    trial[JRY] = q[JRY] + moves * h * mid[JWY]


@kernel
def hand_tilt(q, m, first, second):
    """Put mean (N m) and slope (N m/s) of the moments into m.o; first, second: 1/H (1/s), 12/H^3 (1/s3)."""
    j = m.o.journal
    j.mx, j.my = first * q[JPMX], first * q[JPMY]
    j.dmx, j.dmy = second * q[JQMX], second * q[JQMY]


@kernel
def weigh_tilt(weight):
    """Have micro-steps resolve the tilt, in a bearing whose load depends on it."""
    weight[JRX] = weight[JRY] = 1.0 / TILT_SCALE
    weight[JWX] = weight[JWY] = 1.0 / TILT_RATE_SCALE
