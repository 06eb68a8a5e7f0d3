"""Chapters that one picture of the run tells: stresses along the shaft, spectra."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from touchdown.master.coupling.connections import Attachment
from touchdown.master.report.facts.numbers import quantity
from touchdown.master.report.facts.subject import Subject, number
from touchdown.master.report.page.blocks import Absent, Block, Picture, Table
from touchdown.master.report.pictures.svg import inline
from touchdown.master.results.figures.spectrum import has_spectrum, spectrum
from touchdown.master.results.figures.stress import has_stress, stress
from touchdown.master.results.motion.spectra import BEGIN, LENGTH
from touchdown.master.results.stresses import stressed


def stresses(subject: Subject) -> list[Block]:
    """Bending and shear along the shaft and over time."""
    system = subject.run.system
    rotors = stressed(system)
    if not rotors:
        raise Absent("the rotor tells of none: it is rigid, or known by its matrices, without diameters.")
    shown = [name for name in rotors if has_stress(system, name)]
    if not shown:
        raise Absent("the rotor kept no stress; set stress.active = 1 on it.")
    blocks: list[Block] = []
    for name in shown:
        draw = partial(stress, run=subject.run, name=name)
        alt = f"Bending and shear stress of {name} along its axis and over time"
        caption = (
            f"Stresses of {name}: along the axis both planes at the kept instant, in front of the largest "
            "resultant of the whole run, and over time the largest anywhere. Nominal: no notch factors."
        )
        blocks.append(Picture(inline(draw, f"stress-{name}", alt, wide=True), caption))
    rows = list(_peaks(subject, shown))
    return [
        Table("Largest stresses", ["Stress", "Value", "at node", "after the shutdown"], rows, 1),
        *blocks,
    ]


def _peaks(subject: Subject, rotors: list[str]) -> Iterator[list[str]]:
    for name in rotors:
        tail = f"_{name}" if len(rotors) > 1 else ""
        for kind in ("bending", "shear"):
            value, node, time = (
                number(subject.summary.get(f"peak_{kind}_stress{end}{tail}"))
                for end in ("_MPa", "_node", "_time_s")
            )
            if value is not None:
                at = quantity(node, "1", 3)
                yield [
                    f"{kind.capitalize()}, {name}",
                    quantity(1e6 * value, "Pa", 3),
                    at,
                    quantity(time, "s"),
                ]


def spectra(subject: Subject) -> list[Block]:
    """Of the inner rings' vibration after the landing."""
    shown = [a for a in subject.need_seats() if has_spectrum(subject.run.recording, a)]
    if not shown:
        raise Absent(
            f"a spectrum takes {LENGTH:.3g} s from {BEGIN:g} s after the shutdown on, of a bearing whose "
            "ring is recorded; this run has not that."
        )
    return [_spectrum(subject, a) for a in shown]


def _spectrum(subject: Subject, a: Attachment) -> Picture:
    alt = f"Amplitude spectra of the inner ring's horizontal velocity at {subject.name(a)}"
    svg = inline(partial(spectrum, run=subject.run, a=a), f"spectrum-{a.bearing}", alt, wide=True)
    return Picture(svg, f"Horizontal velocity of the inner ring at {subject.name(a)}, window by window.")
