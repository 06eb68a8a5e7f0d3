"""A sampled PID with filtered derivative, anti-windup and second-order sections behind it; its ports.

At tick n, with the measurement m_n = -y_n and the error e_n = r_n - y_n:

    I_n = I_(n-1) + k_I Ts e_n         kept where the output is beyond its limit and the step leads further
    out D_n = (D_(n-1) + k_D N (m_n - m_(n-1))) / (1 + N Ts)
    u_n = sections(k_P e_n + I_n + D_n)

    C(z) = k_P + k_I Ts z/(z - 1) + k_D N (z - 1)/((1 + N Ts) z - 1), times the sections
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.variables import groups, real

SECTIONS = 4
ROUNDING = 1e-12  # s; a remainder of a macro step, or between events, that only rounding leaves


@dataclass(frozen=True)
class AxisMeasurement:
    """What a bearing tells its controller of an axis."""

    sensed: float = real(0.0, "m", "position in the last sample", nominal=1e-4)
    hold: float = real(0.0, "A", "control current that holds the static load at the centre", constant=True)


@dataclass(frozen=True)
class Command:
    """Command of a controller to an axis."""

    set: float = real(0.0, "A", "control current: bias + set in the + coil, bias - set in the other")
    enable: float = real(1.0, "1", "0: the amplifiers of the axis drive their currents to zero")


@dataclass(frozen=True)
class Gain:
    """Of all channels."""

    proportional: float = real(9.7e3, "A/m", "k_P", tunable=True)
    integral: float = real(4e4, "A/(m.s)", "k_I", tunable=True)
    derivative: float = real(15.5, "A.s/m", "k_D", tunable=True)
    filter: float = real(
        6000.0, "rad/s", "N, cut-off of the derivative", above=0.0, shown="rad/s", needs="derivative"
    )


@dataclass(frozen=True)
class FilterSection:
    """(b0 + b1/z + b2/z2) / (1 + a1/z + a2/z2)."""

    b0: float = real(1.0, "1", "numerator")
    b1: float = real(0.0, "1", "numerator, of 1/z")
    b2: float = real(0.0, "1", "numerator, of 1/z2")
    a1: float = real(0.0, "1", "denominator, of 1/z")
    a2: float = real(0.0, "1", "denominator, of 1/z2")


@dataclass(frozen=True)
class Channel:
    """Parameters of one channel."""

    proportional: float = real(1.0, "1", "k_P of this channel over that of all", tunable=True)
    integral: float = real(1.0, "1", "k_I of this channel over that of all", tunable=True)
    derivative: float = real(1.0, "1", "k_D of this channel over that of all", tunable=True)
    section: tuple = groups(FilterSection, SECTIONS)


@dataclass(frozen=True)
class Delays:
    """A section's memory."""

    first: float = real(0.0, "A", "of the section")
    second: float = real(0.0, "A", "of the section")


@dataclass(frozen=True)
class ChannelMemory:
    """From tick to tick."""

    integral: float = real(0.0, "A", "I")
    derivative: float = real(0.0, "A", "D")
    last: float = real(0.0, "m", "measurement m of the last tick")
    begin: float = real(0.0, "m", "where the lead to the centre began")
    position: float = real(0.0, "m", "y")
    output: float = real(0.0, "A", "u")
    section: tuple = groups(Delays, SECTIONS)


@kernel
def limited(value, limit):
    """The value, cut off at +-`limit`, both in one unit."""
    return min(max(value, -limit), limit)


@kernel
def begin_channel(z, position, integral):
    """Begin the memory z (`ChannelMemory`) anew, at a position (m) and with an integral (A)."""
    z.integral, z.derivative = integral, 0.0
    z.last, z.begin = -position, position
    for n in range(SECTIONS):
        z.section[n].first, z.section[n].second = 0.0, 0.0


@kernel
def update(z, reference, period, limit, gain, channel):
    """Set z.output (A) for z.position (m) and the reference (m), `period` (s) after the last time.

    limit (A): beyond it the integral is kept. gain: `Gain`; channel: `Channel`.
    """
    y = z.position
    error = reference - y
    slope = gain.derivative * channel.derivative * gain.filter * (-y - z.last)
    z.derivative = (z.derivative + slope) / (1.0 + gain.filter * period)
    z.last = -y
    step = gain.integral * channel.integral * period * error
    direct = gain.proportional * channel.proportional * error + z.derivative
    unlimited = direct + z.integral + step
    if abs(unlimited) <= limit or unlimited * step < 0.0:
        z.integral += step
    v = direct + z.integral
    for n in range(SECTIONS):
        c, w = channel.section[n], z.section[n]
        out = c.b0 * v + w.first
        w.first, w.second = c.b1 * v - c.a1 * out + w.second, c.b2 * v - c.a2 * out
        v = out
    z.output = v
