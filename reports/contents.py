"""The chapters of a report, in the order of ISO 14839-5's scope (touchdown bearings) where it has them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from ..master.results.ratings import Origin
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
    scope: str = ""  # letter in SCOPE
    folder: str = "chapters"  # of its template


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


SCOPE = {  # of ISO 14839-5:2022 in other words; the publisher shows it, the standard itself was not at hand
    "a": "What a system of touchdown bearings is built of, and what each part does",
    "b": "What it has to achieve, as targets",
    "c": "What to consider in the dynamics of rotor, touchdown and magnetic bearings",
    "d": "The surroundings that matter to touchdown bearings",
    "e": "Operation and failures of the magnetic bearings that lead to contact",
    "f": "How touchdown bearings fail, and what is done about it",
    "g": "Design: loads, sizing, analysis and simulation",
    "h": "Acceptance tests: conditions and instruments",
    "i": "Monitoring and inspection in service",
}


def scope(subject: Subject) -> Data:
    """By items of the scope the chapters that a run has, and why it has not the others."""
    rows = []
    for letter, what in SCOPE.items():
        of_item = [section(chapter, subject) for chapter in CHAPTERS if chapter.scope == letter]
        answered = "; ".join(one.title for one in of_item if not one.lacking)
        rows.append((f"{letter}) {what}", answered, [one for one in of_item if one.lacking]))
    return {"rows": rows}


def _short_settings(subject: Subject) -> Data:
    """What is not at its default, without meanings."""
    found = settings(subject)
    rows = [*found["run"], *(row for part in found["parts"] for row in part["chosen"])]
    return {"rows": [row for row in rows if row[2] != Origin.DEFAULT]}


SHORT = (
    Chapter("summary", "The decision", lambda of: summary(of) | {"verdicts": []}),
    Chapter("machine", "The machine", lambda of: machine(of) | drop(of), folder="short"),
    Chapter("drop", "The drop", lambda of: drop(of) | forces(of), folder="short"),
    Chapter("model", "What it rests on", lambda of: model(of) | {"command": ""}),
    Chapter("scope", "By the scope of ISO 14839-5:2022", scope, folder="short"),
    Chapter("settings", "Appendix: settings that are not defaults", _short_settings, folder="short"),
)


def section(chapter: Chapter, subject: Subject) -> Section:
    """A chapter as printed."""
    return laid_out(chapter.name, chapter.title, chapter.folder, partial(chapter.tell, subject))
