"""What runs differ in: settings, and the quantities that came of them; overlaid pictures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...master.common.errors import TouchdownError
from ...master.common.text import aligned, variable_unit
from ...master.components.component import ScalarVariable, value_of
from ...master.quantities import Item, Summary, summary_items
from ...master.results.final_state import Finished
from ...master.results.folder import SUMMARY_FILE, reopened
from ...master.results.result import Result
from ...master.results.table import WIDEST, shown_value
from ...master.scene.run_spec import UNITS
from ...master.scene.scene import Scene
from ...modelkit.errors import require
from ...modelkit.units import per_display, to_si
from ...reports.figures.overlay import overlays
from ..findings import Findings
from ..sweep.definition import DEFINITION_FILE
from ..sweep.results import read

if TYPE_CHECKING:
    import pandas

OF_COMPONENTS = ("fmu", "preset", "every", "sampled")  # said of a component beside its variables
DEFAULTS = None, 1, 0.0  # of these
OF_SCENES = ("attach", "sense", "control", "connect", "bond", "gaps", "requirements", "inclination")
NOT_SET = "-"
OTHER_UNITS = {"inclination": "rad", **{f"run.{key}": unit for key, unit in UNITS.items()}}


@dataclass(frozen=True)
class Side:
    """A run, or a drop of a sweep of which only the summary is left."""

    label: str
    scene: Scene
    summary: Summary
    run: Finished | None = None

    @property
    def settings(self) -> dict[str, Any]:
        """All that is set and may change a number, by name."""
        plain: dict[str, Any] = self.scene.resolved()
        found = {f"run.{key}": value for key, value in plain["run"].items()}
        for name, spec in plain["components"].items():
            found |= {f"{name}.{key}": spec[key] for key in OF_COMPONENTS if spec[key] not in DEFAULTS}
            found |= {f"{name}.{variable}": value for variable, value in spec["set"].items()}
        return found | {key: plain[key] for key in OF_SCENES}

    def in_force(self, name: str) -> tuple[float | None, ScalarVariable | None]:
        """Value (SI) and variable of a setting; None where they are not known."""
        component, _, variable = name.partition(".")
        if self.run is None or name not in self.run.system:
            return None, None
        return self.run.system.value(name), self.run.system.components[component].variables[variable]


@dataclass(frozen=True)
class Differences:
    """Of runs from the first of them."""

    sides: Sequence[Side]

    @property
    def settings(self) -> dict[str, list[str]]:
        """Those that differ, by name: of each run, in one form however it was written."""
        every = [side.settings for side in self.sides]
        found: dict[str, list[str]] = {}
        for name in dict.fromkeys(name for one in every for name in one):
            defaults, variables = zip(*(side.in_force(name) for side in self.sides), strict=True)
            of = next(filter(None, variables), None)
            unit = OTHER_UNITS.get(name) if of is None else of.unit or "1"
            values = [
                _in_si(name, one.get(name, d), unit, of) for one, d in zip(every, defaults, strict=True)
            ]
            if len(set(values)) > 1:
                found[name] = _written(values, unit, of)
        return found

    def items(self, everything: bool = False) -> list[Item]:
        """The quantities whose values differ as people read them; with `everything` all that there are."""
        items = summary_items(*(side.summary for side in self.sides))
        if everything:
            return items
        shown = [i for i in items if not (i.quantity.detail or i.quantity.machine)]
        return [i for i in shown if len({_shown(i, side.summary) for side in self.sides}) > 1]

    def to_pandas(self) -> pandas.DataFrame:
        """All quantities by their paths, in SI, a column for each run."""
        import pandas

        items = self.items(True)
        return pandas.DataFrame({s.label: {i.path: i.of(s.summary) for i in items} for s in self.sides})

    def findings(self, everything: bool = False) -> Findings:
        """For the console; pictures for a folder."""
        runs = {side.label: side.run for side in self.sides if side.run is not None}
        rows = [("settings", *(side.label for side in self.sides))]
        rows += [(name, *values) for name, values in self.settings.items()]
        lines = aligned(rows) if len(rows) > 1 else ["no setting differs"]
        return Findings([*lines, *self._of_quantities(everything)], pictures=dict(overlays(runs)))

    def _of_quantities(self, everything: bool) -> list[str]:
        """Numbers beside each other, texts in a line each."""
        first, *others = self.sides
        heads = (part for side in others for part in (side.label, ""))
        rows: list[tuple[str, ...]] = [("", first.label, *heads)]
        for group, of_group in groupby(self.items(everything), lambda i: i.quantity.group):
            rows.append((group,))
            for i in of_group:
                values = [_shown(i, side.summary) for side in self.sides]
                if not i.quantity.unit:
                    rows.append((f"  {i.words}", " | ".join(values)))
                    continue
                parts = zip(values[1:], (_change(i, first, side) for side in others), strict=True)
                rows.append((f"  {i.head}", values[0], *(part for pair in parts for part in pair)))
        return ["", *aligned(rows, "<>")] if len(rows) > 1 else ["no quantity differs"]


def differences(runs: Iterable[Result | str | Path]) -> Differences:
    """Of runs, their folders, or drops of sweeps as FOLDER/NUMBER. Raises TouchdownError."""
    given = list(runs)
    require(len(given) > 1, "a difference takes two runs or more; give another folder")
    paths = [one.folder if isinstance(one, Result) else Path(one) for one in given]
    names = [path.name for path in paths]
    labels = names if len(set(names)) == len(names) else [str(path) for path in paths]
    require(len(set(labels)) == len(labels), f"{labels[0]} is there twice; give different runs")
    return Differences([_side(label, one) for label, one in zip(labels, given, strict=True)])


def _side(label: str, run: Result | str | Path) -> Side:
    if not isinstance(run, Result):
        path = Path(run)
        of_sweep = path.name.isdecimal() and (path.parent / DEFINITION_FILE).is_file()
        if of_sweep and not (path / SUMMARY_FILE).is_file():
            return _member(label, path.parent, int(path.name))
        run = reopened(path)
    return Side(label, run.scene, run.summary, Finished(run.scene, run.ending, run.recording))


def _member(label: str, folder: Path, number: int) -> Side:
    sweep = read(folder)
    scene, member = sweep.scene(number), sweep[number - 1]
    require(member.summary, f"drop {number} of {folder} has no results: {member.failed}")
    return Side(label, scene, dict(member.summary))


def _in_si(name: str, value: object, unit: str | None, of: ScalarVariable | None) -> float | str:
    """A number in SI, to the digits that its text may have; else its text."""
    with suppress(TouchdownError):
        read = value_of(name, of, value) if of else to_si(value, unit, name) if unit else None
        if read is not None:
            return float(f"{read:.12g}") if isinstance(read, float) else read
    return NOT_SET if value is None else str(value)


def _written(values: Sequence[float | str], unit: str | None, of: ScalarVariable | None) -> list[str]:
    """Numbers in the unit in which people read the largest of them, or by words; long texts are cut."""
    largest = max((abs(v) for v in values if isinstance(v, float)), default=0.0)
    shown = variable_unit(of.name if of else "", unit or "1", largest)
    factor, behind = per_display(unit or "1", shown), "" if shown == "1" else f" {shown}"
    texts = [
        v if isinstance(v, str) else of.in_words(v) if of and of.choices else f"{factor * v:.6g}{behind}"
        for v in values
    ]
    return [text if len(text) <= WIDEST else f"{text[: WIDEST - 3]}..." for text in texts]


def _shown(item: Item, summary: Summary) -> str:
    value = item.of(summary)
    return f"{item.quantity.factor * value:.4g}" if isinstance(value, float) else shown_value(item, summary)


def _change(item: Item, first: Side, other: Side) -> str:
    """From the first run to another, in the unit in which people read it, and in parts of the first."""
    before, after = item.of(first.summary), item.of(other.summary)
    if before == after or not all(isinstance(v, int | float) for v in (before, after)):
        return ""
    is_size = before and not item.quantity.key.endswith("_node")
    part = f" ({100.0 * (after - before) / abs(before):+.1f} %)" if is_size else ""
    return f"{item.quantity.factor * (after - before):+.3g}{part}"
