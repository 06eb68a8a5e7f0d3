"""The loops of a scene as text."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...master.common.text import HZ, RPM, aligned, joined, percent
from .linear_loops import Controlled, MeasuredLaws, Sampled, shortfalls
from .margins import zone
from .measured_response import LOOP, Measured
from .over_speed import AtSpeed, Found, damping_ratio, settled
from .response import UnbalanceResponse
from .response import zone as vibration_zone

POLES = 6  # that swing, in the report
MIN_IMAGINARY = 1e-2  # of a pole's size; less does not swing


def lines(found: Found) -> Iterator[str]:
    """The report, a line each; what makes the loops useless first."""
    yield from found.faults
    yield found.scene.title
    loops, nominal = found.loops, found.own
    if isinstance(loops, Sampled):
        yield f"sampled every {1e6 * loops.period:g} us; {_law(loops)}"
        if loops.left_out:
            yield f"across the shaft; {joined(loops.left_out)} along it is not in these loops"
        if loops.period > loops.tick:
            tick = f"{1e6 * loops.tick:g} us"
            yield f"bearings sample every {tick}; the last sample in a law's period acts {tick} later"
        for bearing in loops.bearings:
            yield _magnet(bearing, found.clearance)
        yield from _budget(loops, nominal)
    else:
        yield "amb is a spring and a damper; magnets, amplifiers, samples (amb_actuator) lower its margins"
    yield f"\nat {RPM * nominal.speed:g} rpm, all other loops closed:"
    rows: list[tuple[str, ...]] = [
        ("loop", "max |S|", "dB", "zone", "at Hz", "crossover Hz", "delay margin ms")
    ]
    for name, one in zip(loops.names, nominal.margins, strict=False):
        crossing = f"{HZ * max(one.crossings):.4g}" if one.crossings else "none"
        delay = f"{1e3 * one.delay:.4g}" if math.isfinite(one.delay) else "any"
        sizes = f"{one.peak:.4f}", f"{20 * math.log10(one.peak):.2f}", one.zone, f"{HZ * one.at:.2f}"
        rows.append((name, *sizes, crossing, delay))
    if not nominal.margins:
        rows += [(name, _useless(nominal)) for name in loops.names]
    yield from aligned(rows, "<>><>", "  ")
    yield from (f"  {one.words()}" for one in found.required)
    yield "  zones by the limits 3, 4, 5 (9.5, 12, 14 dB) of ISO 14839-3, as secondary sources quote them"
    if found.measured is not None:
        yield from _measured(found.measured, nominal.speed)
    yield "\nover the speed, the worst loop, and the least damped pole:"
    head = "rpm", "max |S|", "zone", "damping ratio", "Hz"
    yield from aligned([head, *map(_worst, found.speeds)], ">><>", "  ")
    if found.unbalance is not None and not loops.too_weak and nominal.unstable is None:
        yield from _response(found, found.unbalance)
    if nominal.bending:
        yield f"\nbending modes at {RPM * nominal.speed:g} rpm, free and with the loops closed:"
        modes = [(f"{HZ * mode.free.imag:.4g}", *_swing(mode.pole)) for mode in nominal.bending]
        yield from aligned([("free Hz", "Hz", "damping ratio"), *modes], ">", "  ")
    yield f"\nleast damped poles at {RPM * nominal.speed:g} rpm:"
    yield from aligned([("real 1/s", "Hz", "damping ratio"), *_poles(nominal.shown)], ">", "  ")
    yield from (f"  {one}" for one in filter(None, [found.left_out]))


def _measured(found: Measured, speed: float) -> Iterator[str]:
    """S beside that of the linear loops at the same lines, and what of the others is off."""
    omega, size = HZ * found.answers.omega, f"{1e6 * found.amplitude:g} um, force {found.force:.3g} N"
    yield (
        f"\nmeasured in the nonlinear run at {RPM * speed:g} rpm, without events, unbalance and noise "
        f"({len(omega)} lines from {omega[0]:.4g} to {omega[-1]:.4g} Hz, each {size}):"
    )
    rows = [["loop", "max |S|", "zone", "linear", "zone", "at Hz", *(f"{name} off %" for name in "SPCG")]]
    for k, name in enumerate(found.answers.axes):
        s, linear = (np.abs(each.values["S"][:, k]) for each in (found.answers, found.linear))
        sizes = [text for one in (s, linear) for text in (f"{one.max():.4f}", zone(float(one.max())))]
        off = [f"{100.0 * found.deviation(one, k):.2g}" for one in "SPCG"]
        rows.append([name, *sizes, f"{omega[int(np.argmax(s))]:.4g}", *off])
    yield from aligned(rows, "<><><>", "  ")
    yield f"  linear and off: at these lines alone, largest deviation; of P where |L| is above {LOOP:g}"
    yield f"  at half the amplitude S of the worst loop changes by {percent(found.halved)}"
    yield from (f"  {line}" for line in found.remarks)


def _worst(at_speed: AtSpeed) -> tuple[str, ...]:
    """At a speed: the worst loop's peak and zone, and the least damped pole."""
    peak, pole = max((one.peak for one in at_speed.margins), default=math.nan), at_speed.shown[0]
    judged = (f"{peak:.4f}", zone(peak)) if at_speed.margins else (_useless(at_speed), "")
    return f"{RPM * at_speed.speed:.0f}", *judged, f"{damping_ratio(pole):.4f}", f"{HZ * pole.imag:.4g}"


def _swing(pole: complex) -> tuple[str, str]:
    """Frequency and damping ratio."""
    return f"{HZ * pole.imag:.4g}", f"{damping_ratio(pole):.5f}"


def _useless(at_speed: AtSpeed) -> str:
    """Instead of a peak and a zone."""
    return "unstable" if at_speed.unstable is not None else "too weak"


def _budget(loops: Sampled, nominal: AtSpeed) -> Iterator[str]:
    """Of each axis, what bias, static load and unbalance take of its limits."""
    swings = settled(loops, nominal.speed, nominal.poles)
    counted = (
        f"unbalance at {RPM * nominal.speed:g} rpm" if swings else "without unbalance: nothing settles"
    )
    yield f"\ncurrents (A) and flux densities (T) at the centre, {counted}:"
    rows = [["loop", "bias", "holding", "unbalance", "sum", "limit", "flux", "limit"]]
    for k, name in enumerate(loops.names):
        one = loops.bearings[k // 2].axes[k % 2]
        control, fluxes = swings.of(k) if swings else (0.0, [])
        bias, limit = one.amplifier.bias, one.amplifier.current_limit
        sizes = bias, abs(one.hold), control, one.demand(control), limit, one.density(fluxes)
        cells = [f"{size:.4g}" for size in (*sizes, one.magnet.flux_limit)]
        rows.append([name, *cells[:2], cells[2] if swings else "-", *cells[3:]])
    yield from aligned(rows, "<>", "  ")
    yield from (f"  {line}" for line in shortfalls(loops.bearings, swings))


def _response(found: Found, response: UnbalanceResponse) -> Iterator[str]:
    """Orbits beside the room they have, and currents and voltages beside their limits."""
    loops, speed = found.loops, abs(found.loops.speed)
    limits = f"{RPM * speed:g} rpm and largest up to {RPM * response.speeds[-1]:.0f} rpm"
    yield f"\norbits by the unbalance (larger half-axis), at {limits}:"
    rows = [["place", "um", "zone", "largest um", "at rpm", "room um", "of it %"]]
    for k, place in enumerate(response.places):
        now, most, at = _amplitudes(response, response.orbits[:, k], speed)
        judged = vibration_zone(now / place.room) if place.is_sensor and place.room else ""
        room = [f"{1e6 * place.room:g}", f"{100.0 * most / place.room:.3g}"] if place.room else ["", ""]
        sizes = f"{1e6 * most:.4g}", f"{RPM * at:.0f}"
        rows.append([place.name, f"{1e6 * now:.4g}", judged, *sizes, *room])
    yield from aligned(rows, "<><>", "  ")
    yield (
        f"  zones at {RPM * speed:g} rpm by ISO 14839-2 as secondary sources quote it: limits of 0.3, 0.4, "
        "0.5 of the least clearance"
    )
    if not isinstance(loops, Sampled):
        return
    yield f"\ncontrol currents and coil voltages by the unbalance, at {limits}:"
    rows = [["loop", "A", "largest A", "at rpm", "left A", "largest V", "at rpm", "left V"]]
    for k, name in enumerate(response.axes):
        one = loops.bearings[k // 2].axes[k % 2]
        now, most, at = _amplitudes(response, response.currents[:, k], speed)
        _, volts, then = _amplitudes(response, response.voltages[:, k], speed)
        left = one.amplifier.current_limit - one.demand(0.0), one.voltage - one.resting_voltage
        currents = [f"{now:.4g}", f"{most:.4g}", f"{RPM * at:.0f}", f"{left[0]:.4g}"]
        rows.append([name, *currents, f"{volts:.4g}", f"{RPM * then:.0f}", f"{left[1]:.4g}"])
    yield from aligned(rows, "<>", "  ")


def _amplitudes(
    response: UnbalanceResponse, values: np.ndarray, speed: float
) -> tuple[float, float, float]:
    """Of a column (n,): at a speed (rad/s), the largest, and the speed (rad/s) of that; nan: unstable."""
    if np.isnan(values).all():
        return math.nan, math.nan, math.nan
    most = int(np.nanargmax(values))
    return float(response.at(speed, values)), float(values[most]), float(response.speeds[most])


def _law(loops: Sampled) -> str:
    """When set points act, or how well the law is known that was measured."""
    laws = loops.laws
    if isinstance(laws, MeasuredLaws):
        misfit = max(getattr(law, "misfit", 0.0) for law in laws.laws)
        states = sum(len(law.A) for law in laws.laws)
        return (
            f"C(z) measured, {states} states, which miss the lines by {misfit:.1g} of the largest; an "
            "answer acts at the next sample"
        )
    later = "a sample" if laws.delay == 1 else f"{laws.delay} samples"
    return "; ".join((f"set points act {later} later", *laws.remarks))


def _magnet(bearing: Controlled, clearance: float) -> str:
    """A line on the magnets' capacity."""
    one = bearing.axes[0]
    factors = [
        joined(dict.fromkeys(f"{getattr(axis, key) / scale:.4g}" for axis in bearing.axes))
        for key, scale in (("current_factor", 1.0), ("displacement_factor", 1e3), ("slew", 1e3))
    ]
    values = "{}: k_i {} N/A, k_s {} kN/m, slew {} kN/s".format(bearing.name, *factors)
    if not clearance or not bearing.load:
        return values
    lifting = one.lifting_current(bearing.load, clearance, bearing.angle)
    where = f"from {1e3 * clearance:g} mm below the centre"
    return f"{values}; {lifting:.4g} A in its coils lift {bearing.load:.4g} N {where}"


def _poles(poles: np.ndarray) -> Iterator[tuple[str, ...]]:
    """Those that swing, the least damped first, and the slowest of the others."""
    swinging = [p for p in map(complex, poles) if abs(p.imag) >= MIN_IMAGINARY * abs(p)]
    steady = sorted((p.real for p in map(complex, poles) if p not in swinging), reverse=True)
    yield from [*dict.fromkeys((f"{p.real:.4f}", *_swing(p)) for p in swinging)][:POLES]
    yield from ((f"{real:.4f}", "does not swing; the slowest of these") for real in steady[:1])
