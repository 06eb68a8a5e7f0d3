"""Figures as text: rows of cells in columns; those of a run, grouped, several bearings side by side."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from .heat import PARTS
from .summary import SPREAD

# Of how it was computed, and what other figures say in words; shown where all is
NUMERICS = (
    *("energy_", "exchange", "macro_step", "wall_time", "start_up", "simulated", "time_at_"),
    *("not_", "proposed_", "requirement_margin_", "drops_until_fatigue"),
    *("kept_", "peak_bending_stress_time", "peak_shear_stress_time"),
    *(f"bearing_heat_{part}" for part in PARTS),
    *("bearing_sliding_work", "temperature_rise_", "play_change", "clearance_change"),
)
OTHERS = "others"
GROUPS: Mapping[str, tuple[str, ...]] = {  # heading: what keys begin with; the first that fits counts
    "the drop": (
        "scene",
        "completed",
        "ended",
        "stopped",
        "end_time",
        "rotor_speed_end",
        "contact_estimated",
    ),
    "landing": (
        *(
            "first_contact",
            "face_landing",
            "first_impact_ball",
            "first_impact_cage",
            "first_impact_contact",
            "first_impact_face",
            "first_impact_neighbour",
        ),
        "first_impact_indentation",
    ),
    "largest of the whole run": (
        *("peak_contact", "peak_ball", "peak_cage", "peak_indentation", "peak_face", "peak_neighbour"),
        *("largest_displacement", "largest_journal"),
    ),
    "motion": ("whirl_", "settl", "pendulum", "loaded_balls", "ring_sync", "proposed_"),
    "gaps and strokes": ("gap_", "least_gap", "housing_stroke", "stop_", "mount_"),
    "strength and heat": (
        *("largest_ball_pressure", "lowest_static_safety", "bearing_", "drops_until_fatigue"),
        *("temperature_rise_", "play_change", "clearance_change", "largest_temperature"),
        *("seized_", "ring_stop", "runaway_", "play_used_up"),
    ),
    "stress in the rotor": ("peak_bending", "peak_shear", "first_impact_", "kept_"),
    "levitation": ("capture_", "amb_"),
    "requirements": ("requirement",),
    OTHERS: (),
    "how it was computed": (
        *("scheme", "exchange", "macro_step", "energy_", "wall_time", "start_up", "simulated", "time_at_"),
        "not_",
    ),
}
LANDED = "first_contact_time_s_"  # each bearing has it, and its name follows
WIDEST = 24  # of a value beside others; a longer one has a line of its own


def aligned(rows: Sequence[Sequence[str]], sides: str = "<") -> list[str]:
    """Rows of cells as lines; sides: < or > for each column, left or right, the last for all others."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    forms = [*zip(sides.ljust(len(widths), sides[-1]), widths, strict=True)]
    lines = (
        "  ".join(f"{cell:{side}{width}}" for cell, (side, width) in zip(row, forms, strict=True))
        for row in rows
    )
    return [line.rstrip() for line in lines]


def table(summary: Mapping[str, object], everything: bool = True) -> str:
    """The figures by groups; without `everything` those of the drop that there are.

    Of several bearings a figure's key is that of the row, and _ and the name over the column.
    """
    figures = {key: value for key, value in summary.items() if key != SPREAD}  # told beside them
    if not everything:
        figures = {k: v for k, v in figures.items() if v is not None and not k.startswith(NUMERICS)}
    bearings = bearings_of(summary)
    width = max(len(stem_of(key, bearings)[0]) for key in figures) + 2
    lines: list[str] = []
    for group in GROUPS:
        keys = [key for key in figures if _group(key) == group]
        if keys:
            rows = list(_rows({key: shown(figures[key], key) for key in keys}, bearings, width))
            lines += [group, *rows] if len(keys) < len(figures) else rows
    return "\n".join(lines)


def bearings_of(keys: Iterable[str]) -> list[str]:
    """Names of the bearings, where there are several, by the keys of a summary."""
    return [key.removeprefix(LANDED) for key in keys if key.startswith(LANDED)]


def by_group(keys: Iterable[str]) -> dict[str, list[str]]:
    """Keys of summaries under the headings of `GROUPS`, those of a figure at several bearings together."""
    known = list(keys)
    bearings = bearings_of(known)
    beside: dict[str, list[str]] = {}
    for key in known:
        beside.setdefault(stem_of(key, bearings)[0], []).append(key)
    groups: dict[str, list[str]] = {group: [] for group in GROUPS}
    for same in beside.values():
        groups[_group(same[0])] += same
    return {group: found for group, found in groups.items() if found}


def _group(key: str) -> str:
    return next((name for name, begins in GROUPS.items() if key.startswith(begins)), OTHERS)


def shown(value: object, key: str = "") -> str:
    """A figure as text, of the name `key`; of a list how many it has."""
    if value is None:
        return "-"
    if isinstance(value, list):
        return str(len(value))
    if isinstance(value, float):
        return f"{round(value, 9) if '_um' in key else value:.6g}"  # less is rounding
    return str(value)


def stem_of(key: str, bearings: Iterable[str]) -> tuple[str, str]:
    """A key without the bearing's name that ends it, and that name, or ""."""
    for name in bearings:
        if key.endswith(f"_{name}"):
            return key.removesuffix(f"_{name}"), name
    return key, ""


def _rows(values: Mapping[str, str], bearings: list[str], width: int) -> Iterator[str]:
    """Lines of a group: first what is of no bearing, then the bearings' in columns."""
    beside: dict[str, dict[str, str]] = {}
    for key, text in values.items():
        stem, name = stem_of(key, bearings)
        if not name:
            yield f"  {key:<{width}}{text}"
        else:
            beside.setdefault(stem, {})[name] = text
    short = {stem: of for stem, of in beside.items() if all(len(text) <= WIDEST for text in of.values())}
    if short:
        cells = [text for of in short.values() for text in of.values()]
        column = max(len(text) for text in (*cells, *bearings)) + 2
        yield f"  {'':<{width}}" + "".join(f"{name:<{column}}" for name in bearings).rstrip()
        for stem, of in short.items():
            row = "".join(f"{of.get(name, ''):<{column}}" for name in bearings)
            yield f"  {stem:<{width}}{row}".rstrip()
    for stem, of in beside.items():
        if stem not in short:
            yield from (f"  {f'{stem}_{name}':<{width}}{text}" for name, text in of.items())
