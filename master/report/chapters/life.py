"""Sizing: static safety of the rolling bearings, and drops until a limit. Estimates."""

from __future__ import annotations

import math

from touchdown.master.report.facts.numbers import digits, listed, quantity, share
from touchdown.master.report.facts.rating import Rated, rated
from touchdown.master.report.facts.subject import Subject
from touchdown.master.report.page.blocks import Absent, Block, Lacking, Table, Text

USUAL = 2.0  # s_0 that makers ask for under shocks
MOST_DROPS = 1e6  # more are said to be more


def life(subject: Subject) -> list[Block]:
    """Static safety and fatigue."""
    told = {subject.name(a): rated(subject, a) for a in subject.need_seats()}
    found = {seat: one for seat, one in told.items() if isinstance(one, Rated)}
    if not found:
        raise Absent(f"{listed([str(why) for why in told.values()])}.")
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    return [
        Text(
            "Estimates: load ratings are of bearings that run long and lubricated. A touchdown bearing is "
            "hit, skids while it is spun up, and is warmed by that, none of which is in them."
        ),
        _static(found),
        _fatigue(found),
        *_words(found),
        *(Lacking(f"Ratings at {seat}", f"{why}.") for seat, why in told.items() if isinstance(why, str)),
    ]


def _static(found: dict[str, Rated]) -> Table:
    rows = [
        [
            seat,
            quantity(one.capacity.static, "N", 3),
            one.stated.static,
            quantity(one.equivalent_load, "N", 3),
            digits(one.static_safety, 3),
            digits(one.pressure_safety, 3),
        ]
        for seat, one in found.items()
    ]
    head = [
        *("Seat", "Static rating C₀", "C₀ from", "Equivalent load P₀", "s₀ = C₀/P₀"),
        "Safety against 4.2 GPa",
    ]
    return Table("Static safety at the largest ball load of the run", head, rows, 1)


def _fatigue(found: dict[str, Rated]) -> Table:
    rows = [
        [
            seat,
            quantity(one.capacity.dynamic, "N", 3),
            one.stated.dynamic,
            digits(one.turns, 3),
            share(one.damage),
            f"more than {MOST_DROPS:,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}")
            if one.drops > MOST_DROPS
            else digits(one.drops, 2),
        ]
        for seat, one in found.items()
    ]
    head = ["Seat", "Dynamic rating C", "C from", "Turns of the ring", "Life taken (ISO/TS 16281)", "Drops"]
    return Table("Fatigue: such drops until one in ten bearings has failed", head, rows, 1)


def _words(found: dict[str, Rated]) -> list[Block]:
    said: list[Block] = []
    dented = [seat for seat, one in found.items() if one.pressure_safety < 1.0]
    if dented:
        said.append(
            Text(
                f"At {listed(dented)} the races are pressed beyond 4.2 GPa: the first drop reaches the "
                "limit, and dents them."
            )
        )
    close = [seat for seat, one in found.items() if 1.0 <= one.pressure_safety < USUAL]
    if close:
        said.append(
            Text(f"At {listed(close)} the safety against dents is below {USUAL:g}, usual under shocks.")
        )
    if all(math.isinf(one.drops) or one.drops > MOST_DROPS for one in found.values()):
        said.append(Text("Fatigue: this run takes less than a millionth of a life."))
    said.append(
        Text(
            "Both count this run only; a rotor that still turns at its end goes on. P₀ is the radial load "
            "that would press the most loaded ball as hard as the run's largest load did, by the share "
            "that ISO 76 gives that ball. The life taken sums turns of the ring over the life at each "
            "moment's recorded load (Palmgren and Miner)."
        )
    )
    return said
