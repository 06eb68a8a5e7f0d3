"""How far the figures can be trusted as numerics: what the energy ledger and the steps say."""

from __future__ import annotations

from functools import partial

from touchdown.master.report.facts.numbers import quantity, share
from touchdown.master.report.facts.subject import Subject, number
from touchdown.master.report.page.blocks import Block, Lacking, Picture, Table, Text
from touchdown.master.report.pictures.svg import inline
from touchdown.master.results.figures.energy import energy
from touchdown.master.results.summary import energy_total

FINE = 1e-3  # of the turnover: what the coupling makes or loses says nothing against the figures
MADE_INSIDE = 0.02  # of the turnover, inside a bearing; beyond it the run has warned
NAMES = {
    "energy_turnover_J": ("Energy that crossed between the parts", "J"),
    "energy_made_J": ("of it made by the coupling", "J"),
    "energy_residual_of_turnover": ("Ledger's residual, worst connection", "share"),
    "energy_made_of_turnover": ("Energy made, share of what crossed", "share"),
    "energy_made_inside_of_turnover": ("Energy made inside a bearing, worst", "share"),
    "energy_balance_relative": ("Sum of all energies, drift over m g c", "share"),
    "macro_step_s": ("Macro step", "s"),
    "macro_steps": ("Macro steps", "1"),
    "wall_time_s": ("Wall time", "s"),
}


def accuracy(subject: Subject) -> list[Block]:
    """Ledger, steps, energies."""
    rows = []
    for key, (name, unit) in NAMES.items():
        value = number(subject.summary.get(key))
        if value is not None:
            rows.append([name, share(value) if unit == "share" else quantity(value, unit)])
    worst = subject.summary.get("energy_residual_worst_connection")
    if isinstance(worst, str):
        rows.append(["Worst connection", worst])
    rows.append(["Coupling scheme", str(subject.summary.get("scheme", ""))])
    blocks: list[Block] = [
        *_judged(subject),
        Table("What the ledger and the steps say", ["Figure", "Value"], rows, 1),
    ]
    unaudited = subject.summary.get("not_audited")
    if isinstance(unaudited, str):
        blocks.append(Lacking("The account of", f"{unaudited}."))
    return [*blocks, _energies(subject)]


def _judged(subject: Subject) -> list[Block]:
    made = number(subject.summary.get("energy_made_of_turnover"))
    if made is None:
        return [Lacking("A judgement by energy", "no energy crossed between parts that account for it.")]
    verb = "made" if made > 0.0 else "lost"
    said = f"The coupling {verb} {share(abs(made))} of the energy that crossed it"
    worst = number(subject.summary.get("energy_residual_of_turnover")) or 0.0  # made and lost may cancel
    if worst > abs(made):
        said += f", and at one connection {share(worst)} of what crossed there"
    inside = number(subject.summary.get("energy_made_inside_of_turnover")) or 0.0
    if inside > MADE_INSIDE:
        said += f"; inside the worst bearing {share(inside)} of what was turned over was made or lost"
    if max(abs(made), worst) <= FINE and inside <= MADE_INSIDE:
        return [Text(f"{said}: as far as energy tells, the macro step is fine enough for these figures.")]
    return [
        Text(
            f"{said}: forces and times may be off by as much and more. A run with half the macro step "
            "shows what hangs on it, and `touchdown compare` gives the error by macro step."
        )
    ]


def _energies(subject: Subject) -> Block:
    if energy_total(subject.run.system, subject.run.recording) is None:
        return Lacking("Where the energy is", "not all parts state and record their energies.")
    alt = "Energies of all parts over time, and their sum, which should stay"
    svg = inline(partial(energy, run=subject.run), "energy", alt, wide=True)
    return Picture(svg, "Where the energy is, and the balance of all: zero where nothing is lost or made.")
