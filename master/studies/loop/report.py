"""The loops of a scene as text and as a picture."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ...common.files import make_writable
from ...scene.scene import Scene
from .figure import draw
from .loops import Controlled, MeasuredLaws, Sampled
from .margins import zone
from .over_speed import Found, loops_in

HZ = 1.0 / (2.0 * math.pi)
RPM = 30.0 / math.pi
POLES = 6  # told, the slowest first
MIN_IMAGINARY = 1e-2  # of a pole's size; less does not swing


def report(scene: Scene, folder: Path, speeds: Sequence[float] = ()) -> str:
    """`loops_in` as text; loop.png in `folder`."""
    found = loops_in(scene, speeds)
    make_writable(folder)
    draw(found, folder / "loop.png")
    return "\n".join(lines(found))


def lines(found: Found) -> Iterator[str]:
    """The report, a line each."""
    yield found.scene.title
    loops, own = found.loops, found.own
    if isinstance(loops, Sampled):
        yield f"sampled every {1e6 * loops.period:g} us; {_law(loops)}"
        for bearing in loops.bearings:
            yield _magnet(bearing, found.clearance)
    yield f"\nat {RPM * own.speed:g} rpm, all other loops closed:"
    yield "  loop               max |S|     dB  zone      at Hz  crossover Hz  delay margin ms"
    for name, one in zip(loops.names, own.margins, strict=True):
        crossing = f"{HZ * max(one.crossings):12.4g}" if one.crossings else "        none"
        delay = f"{1e3 * one.delay:15.4g}" if math.isfinite(one.delay) else "            any"
        yield (
            f"  {name:<17}{one.peak:9.4f}{20 * math.log10(one.peak):7.2f}  {one.zone:<4}"
            f"{HZ * one.at:11.2f}  {crossing}  {delay}"
        )
    yield "  zones by the limits 3, 4, 5 (9.5, 12, 14 dB) of ISO 14839-3, as secondary sources quote them"
    yield "\nover the speed, the worst loop:"
    yield "       rpm  max |S|  zone  least damped pole 1/s"
    for at in found.speeds:
        peak = max(one.peak for one in at.margins)
        unstable = "  unstable" if at.poles[0].real > 0.0 else ""
        yield f"  {RPM * at.speed:8.0f}{peak:9.4f}  {zone(peak):<4}{at.poles[0].real:19.4g}{unstable}"
    yield f"\nleast damped poles at {RPM * own.speed:g} rpm:"
    yield "    real 1/s         Hz   damping ratio"
    yield from _poles(own.poles)


def _law(loops: Sampled) -> str:
    """When set points act, or how well the law is known that was measured."""
    laws = loops.laws
    if isinstance(laws, MeasuredLaws):
        misfit = max(law.misfit for law in laws.laws)
        states = sum(len(law.A) for law in laws.laws)
        return (
            f"C(z) measured, {states} states, which miss the lines by {misfit:.1g} of the largest; an "
            "answer acts at the next sample"
        )
    later = "a sample" if laws.delay == 1 else f"{laws.delay} samples"
    return f"set points act {later} later"


def _magnet(bearing: Controlled, clearance: float) -> str:
    """A line on the magnets' capacity."""
    one = bearing.actuator
    values = (
        f"{bearing.name}: k_i {one.current_factor:.4g} N/A, k_s {one.displacement_factor / 1e3:.4g} kN/m, "
        f"slew {one.slew / 1e3:.4g} kN/s"
    )
    if not clearance or not bearing.load:
        return values
    lifting = one.lifting_current(bearing.load, clearance, bearing.angle)
    where = f"from {1e3 * clearance:g} mm below the centre"
    return f"{values}; {lifting:.4g} A in its coils lift {bearing.load:.4g} N {where}"


def _poles(poles: np.ndarray) -> Iterator[str]:
    """The slowest, of a pair one."""
    shown = [p for p in poles if p.imag >= 0.0 or abs(p.imag) < MIN_IMAGINARY * abs(p)]
    lines: list[str] = []
    for pole in shown:
        swings = abs(pole.imag) >= MIN_IMAGINARY * abs(pole)
        end = f"{HZ * pole.imag:11.4g}{-pole.real / abs(pole):16.4f}" if swings else ""
        lines.append(f"  {pole.real:10.4f}{end}")
    yield from list(dict.fromkeys(lines))[:POLES]
