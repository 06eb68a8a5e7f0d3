"""The table of quantities: its page, and the recipe of docs/architecture.md that adds to it."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from commands import records
from places import ROOT

import touchdown
from touchdown.master import quantities
from touchdown.master.coupling.simulation import opened
from touchdown.master.quantities import Quantity
from touchdown.master.results.table import result_table
from touchdown.studies.sweep.report import report_lines, write_table

DOCS = ROOT / "docs"


def test_the_time_of_a_quantity_is_declared_for_the_same_owner() -> None:
    declared = {(one.owner, one.key) for one in quantities.quantities()}
    timed = [one for one in quantities.quantities() if one.timed_by]
    assert timed
    assert {(one.owner, one.timed_by) for one in timed} <= declared
    assert all(one.timed_by == one.key for one in timed if one.event)


@pytest.mark.parametrize("scene", ["disk-caged-detailed", "disk-upright-caged", "rotor1-9000"])
def test_a_variable_has_the_unit_of_its_quantity(scene: str) -> None:
    """Else a factor would be on every page, and all would agree."""
    with opened(touchdown.load(scene), in_process=True) as system:
        found = [
            (one.key, one.unit, component.variables[one.variable].unit)
            for one in quantities.quantities()
            for component in system.components.values()
            if one.variable in component.variables
        ]
    assert len(found) > 5
    assert [key for key, unit, theirs in found if unit != (theirs or "1")] == []


def added() -> Quantity:
    """The entry of the recipe."""
    page = (DOCS / "architecture.md").read_text("utf-8")
    recipe = page.partition("\n### Add a quantity\n")[2].partition("\n### ")[0]
    inserted = re.search(r"# in master/quantities\.py, after: .*\n((?:.*\n)*?)```", recipe)
    assert inserted
    return eval(f"({inserted[1]})", vars(quantities))[0]


def test_an_entry_is_told_everywhere(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Summary, flat view, console, table and file of a sweep, --pick, and the report."""
    one = added()
    monkeypatch.setitem(quantities._declared, (one.owner, one.key), one)
    scene = touchdown.load("disk-caged-simplified")
    lengths = {"run.duration": ["11 ms", "12 ms"]}
    results = [touchdown.run(scene.set({"run.duration": t}), in_process=True) for t in ("11 ms", "12 ms")]
    speeds = [float(result.data["bearing.ring.omega"][-1]) for result in results]
    assert 10.0 < speeds[0] < speeds[1]  # rad/s; the rotor has landed, and drags the ring along
    path, shown = f"seats.A.{one.key}", [f"{one.factor * speed:.6g}" for speed in speeds]
    for result, speed, text in zip(results, speeds, shown, strict=True):
        assert result.summary["seats"]["A"][one.key] == result.flat[path] == speed
        assert re.search(rf"{re.escape(one.head)} +{text}\n", result_table(result.summary))
    plain = touchdown.sweep(scene, lengths, tmp_path / "sweep", jobs=1, in_process=True)
    members = [replace(m, summary=r.summary) for m, r in zip(plain, results, strict=True)]
    sweep = replace(plain, members=tuple(members))
    write_table(members, tmp_path / "sweep.csv")
    assert [float(row[f"{path} [rad/s]"]) for row in records(tmp_path / "sweep.csv")] == speeds
    assert sweep.data[path].values.tolist() == speeds
    for pick in (one.key, path, "*ring_speed*"):
        lines, complaints = report_lines(members, [pick])
        assert not complaints
        assert all(text in "\n".join(lines) for text in shown)
    (page,) = touchdown.report(sweep)
    assert one.words in page.read_text("utf-8").lower()
