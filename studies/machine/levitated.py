"""Magnets and a controller for a machine: sized by its load, tuned to its loops, judged as written."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from ...master.common.errors import TouchdownError
from ...master.common.text import HZ, RPM
from ...master.scene.file import SCENE_FILE, load_scene
from ...master.scene.scene import Scene
from ...modelkit.kernel.writing import child_path
from ...modelkit.kernel.writing import write as write_file
from ...rotor.beams.shaft import Shaft
from ..loop.design import tuned
from ..loop.linear_loops import Sampled, Unbalance, shortfalls
from ..loop.margins import ZONES, Margins
from ..loop.over_speed import Found, loops_in, settled
from .controlled_text import UNFIT
from .machine_design import CURRENT, FLUX, FORCE_LIMIT_RATIO, GRAVITY, Design, Levitation, Magnets
from .scene_text import scene_text

PERIODS = (100e-6, 50e-6, 25e-6)  # s, from sample to sample, of which the first with zone A is taken
MORE = 1.5  # of the reserve, where bias, load and unbalance take too much
ENLARGED = 4  # times at most
BESIDE = 0.1  # of a bending mode's frequency: a peak nearer to it is the mode's


def levitated(design: Design, files: Mapping[str, str], shaft: Shaft | None) -> tuple[Design, list[str]]:
    """The machine with magnets and a controller, and why not all is well, a line each.

    files: that the scene needs, by name; shaft: of a flexible rotor. Raises TouchdownError where the rotor
    stands on its end, which radial bearings do not hold.
    """
    if design.inclination:
        raise TouchdownError(
            "--controller: nothing would hold the rotor along its inclined shaft; leave --inclination out, "
            "or --controller"
        )
    magnets = Magnets(
        design.levitated_mass * GRAVITY, 2.0 * design.clearance, design.speed, FORCE_LIMIT_RATIO
    )
    with TemporaryDirectory() as folder:
        for name, text in files.items():
            write_file(child_path(Path(folder), name), text)

        def written(levitation: Levitation) -> Scene:
            text = scene_text(replace(design, levitation=levitation))
            write_file(child_path(Path(folder), SCENE_FILE), text)
            return load_scene(folder)

        for _ in range(ENLARGED):
            bare = Levitation(magnets, 0.0, None, _sensors(design, shaft))
            levitation, found = _tuned(design, bare, written)
            lacking = _lacking(found)
            if not lacking:
                break
            magnets = replace(magnets, reserve=MORE * magnets.reserve)
    notes = [*lacking, *_faults(found)]
    if _worst(found)[0] >= ZONES[0][0]:
        notes.append(UNFIT)
    if design.axial:
        notes.append("--controller: until its shoulder lands nothing holds the rotor along its shaft")
    return replace(design, levitation=replace(levitation, about=tuple(_about(found)))), notes


def _sensors(design: Design, shaft: Shaft | None) -> tuple[str, ...]:
    """The rotor's sensors that are called as the magnetic bearings are, if all: sensor_A for amb_A."""
    there = {one.name for one in shaft.sensors} if shaft is not None else set[str]()
    wanted = [s.component.replace("amb", "sensor", 1) for s in design.magnetic]
    return tuple(wanted) if there.issuperset(wanted) else ()


def _tuned(
    design: Design, levitation: Levitation, written: Callable[[Levitation], Scene]
) -> tuple[Levitation, Found]:
    """With the longest sample time that gives zone A, or with that of the lowest peak."""
    tried = list[tuple[float, Levitation, Found]]()
    for period in PERIODS:
        bare = replace(levitation, period=period)
        one = replace(bare, controller=tuned(written(bare), design.levitated_mass))
        found = loops_in(written(one))
        tried.append((_worst(found)[0], one, found))
        if tried[-1][0] < ZONES[0][0] and not found.faults:
            break
    _, one, found = min(tried, key=lambda each: (bool(each[2].faults), each[0]))
    return one, found


def _worst(found: Found) -> tuple[float, float, str, Margins | None]:
    """Largest |S| up to the scene's speed, at which speed (rad/s), of which axis; inf: unstable."""
    ups = [one for one in found.speeds if abs(one.speed) <= abs(found.own.speed)]
    peaks = [
        (margin.peak, up.speed, name, margin)
        for up in ups
        for name, margin in zip(found.loops.names, up.margins, strict=False)
    ]
    if not all(up.margins for up in ups):
        return math.inf, 0.0, "", None
    return max(peaks, key=lambda one: one[0])


def _swings(found: Found) -> Unbalance | None:
    assert isinstance(found.loops, Sampled)
    return settled(found.loops, found.own.speed, found.own.poles)


def _lacking(found: Found) -> list[str]:
    assert isinstance(found.loops, Sampled)
    return list(shortfalls(found.loops.bearings, _swings(found)))


def _faults(found: Found) -> Iterator[str]:
    """Why not all is in zone A, and what may help."""
    remedy = "take a shorter sample_time of amb, a faster amplifier, or sensors where the mode is seen"
    yield from (f"--controller: {line}; {remedy}" for line in found.faults)
    peak, speed, name, margin = _worst(found)
    if margin is None or peak < ZONES[0][0]:
        return
    modes = [mode.free.imag for mode in found.own.bending]
    near = min(modes, key=lambda mode: abs(mode - margin.at), default=0.0)
    of = f", of the bending mode of {HZ * near:.4g} Hz" if abs(near - margin.at) < BESIDE * near else ""
    yield (
        f"--controller: {name} is in zone {margin.zone} at {RPM * speed:.0f} rpm: max |S| is {peak:.3g} at "
        f"{HZ * margin.at:.4g} Hz{of}; {remedy}"
    )


def _about(found: Found) -> Iterator[str]:
    """How its loops and its budget are."""
    loops, swings = found.loops, _swings(found)
    assert isinstance(loops, Sampled)
    yield "Magnets by rules, their controller by a search; `touchdown amb-margins` has more."
    for at in found.speeds:
        if at.margins:
            worst, delay = max(at.margins, key=lambda one: one.peak), min(one.delay for one in at.margins)
            yield (
                f"At {RPM * at.speed:.0f} rpm: max |S| {worst.peak:.3g} (zone {worst.zone}), delay margin "
                f"{1e3 * delay:.3g} ms."
            )
    for k, name in enumerate(loops.names):
        one = loops.bearings[k // 2].axes[k % 2]
        control, fluxes = swings.of(k) if swings else (0.0, [])
        swung = f"{control:.2g} A" if swings else "an unknown current (nothing settles)"
        yield (
            f"{name}: {one.amplifier.bias:g} A bias, {abs(one.hold):.2g} A for the load, "
            f"{swung} for the unbalance, of {CURRENT:g} A; {one.density(fluxes):.2g} of {FLUX:g} T."
        )
