"""The chapters of a report, in the order of ISO 14839-5's scope (touchdown bearings) where it has them.

The standard's scope is public: a) architecture, b) functional requirements, c) dynamic system,
d) environment, e) operation and contact events, f) failure modes, g) loads, sizing and analysis,
h) acceptance tests, i) condition monitoring and inspection, j) life cycle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from .chapters.basis import accuracy, model, repeat, settings
from .chapters.bearings import balls, life, mounts, run_up
from .chapters.contact import along, forces, spectra, stresses
from .chapters.drop import drop, test_figures
from .chapters.heat import heat
from .chapters.levitation import levitation
from .chapters.machine import machine
from .chapters.summary import requirements, summary
from .layout import Absent, Data, Section, laid_out
from .subject import Subject


@dataclass(frozen=True)
class Chapter:
    """One of a report; `templates/chapters/NAME.html` lays it out."""

    name: str  # of its anchor
    title: str
    tell: Callable[[Subject], Data]  # what the template names
    scope: str = ""  # letter in the scope of ISO 14839-5


def _never(why: str) -> Callable[[Subject], Data]:
    """Of a chapter that no run can give."""

    def tell(subject: Subject) -> Data:
        raise Absent(why)

    return tell


CHAPTERS = (
    Chapter("summary", "Summary", summary),
    Chapter("machine", "The machine", machine, "a"),
    Chapter("requirements", "Requirements", requirements, "b"),
    Chapter("model", "What was modelled, and what was left out", model, "c"),
    Chapter(
        "environment",
        "Environment",
        _never("pressure, medium and the temperature around the machine are not modelled."),
        "d",
    ),
    Chapter("drop", "The contact event", drop, "e"),
    Chapter("along", "Along the shaft: landings on the faces", along, "e"),
    Chapter("levitation", "Levitated again", levitation, "e"),
    Chapter("forces", "Contact forces and where they act", forces, "f"),
    Chapter("run-up", "Run-up of rings and balls", run_up, "f"),
    Chapter("spectra", "Spectra", spectra, "f"),
    Chapter("balls", "Ball loads and Hertz pressure", balls, "g"),
    Chapter("life", "Static safety, and drops until a limit", life, "g"),
    Chapter("mounts", "What the bearings sit in: stroke, stop, heat", mounts, "g"),
    Chapter("heat", "Heat of the bearings, and what it does to their gaps", heat, "g"),
    Chapter("stresses", "Shaft stresses", stresses, "g"),
    Chapter("accuracy", "Energy, and what it says about accuracy", accuracy, "g"),
    Chapter("test", "What a drop test would show", test_figures, "h"),
    Chapter(
        "inspection",
        "Condition monitoring and inspection",
        _never(
            "a run says nothing about a bearing in service; the limits above say what a drop may leave."
        ),
        "i",
    ),
    Chapter("settings", "Settings in force", settings),
    Chapter("repeat", "Run it again", repeat),
)


def section(chapter: Chapter, subject: Subject) -> Section:
    """A chapter as printed."""
    return laid_out(chapter.name, chapter.title, "chapters", partial(chapter.tell, subject))
