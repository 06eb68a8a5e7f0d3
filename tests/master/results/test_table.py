"""What `touchdown run` shows of a summary: groups, seats side by side, and what is left to --all."""

from __future__ import annotations

from touchdown.master.quantities import summary_items
from touchdown.master.results.table import result_table

SUMMARY = {
    "scene": "two seats",
    "macro_steps": 6000,
    "seats": {
        "A": {
            "first_contact_time": 0.0071,
            "peak_contact_force": 545.264,
            "whirl": "pendulum",
            "whirl_radius": 31e-6,
            "whirl_frequency": None,
            "whirl_episodes": [],
            "settled": "not settled: swings, decaying",
        },
        "B": {"first_contact_time": 0.0072, "peak_contact_force": None, "settled": "settled"},
    },
    "gaps": {"seal": {"least": -5e-6}},
    "spread": {"quantities": {"seats.A.peak_contact_force": {}}},
}
FORCE = "largest contact force [N]"


def rows(text: str) -> list[list[str]]:
    """Cells of lines, which two spaces part."""
    return [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in text.splitlines()]


def test_groups_have_seats_beside_each_other() -> None:
    lines = rows(result_table(SUMMARY, everything=True))
    at = lines.index(["landing"])
    assert lines[at + 1] == ["A", "B"]
    assert lines[at + 2] == ["first contact, after the shutdown [s]", "0.0071", "0.0072"]
    assert [FORCE, "545.264", "-"] in lines
    assert ["end of the motion, A", "not settled: swings, decaying"] in lines  # long: a line of its own
    assert lines.index(["motion"]) < lines.index(["how it was computed"])


def test_values_are_in_the_units_that_people_read() -> None:
    lines = rows(result_table(SUMMARY, everything=True))
    assert ["radius of the whirl [um]", "31"] in lines
    assert ["least gap left, seal [um]", "-5"] in lines
    assert ["whirls, counted", "0"] in lines


def test_every_quantity_is_shown_once() -> None:
    heads = [row[0] for row in rows(result_table(SUMMARY, everything=True))]
    for item in summary_items(SUMMARY):
        assert sum(head in (item.quantity.head, item.head) for head in heads) == 1, item.path
    assert not any("spread" in head for head in heads)


def test_the_short_one_leaves_out_numerics_and_what_did_not_happen() -> None:
    text = result_table(SUMMARY, everything=False)
    assert "macro steps" not in text
    assert "frequency" not in text
    assert ["largest contact force, A [N]", "545.264"] in rows(text)


def test_what_one_of_several_has_tells_whose_it_is() -> None:
    """And columns stand in one order, whichever seat has a value first."""
    seats = {"A": {"peak_contact_force": 1.0}, "B": {"first_contact_time": 0.5, "peak_contact_force": 2.0}}
    seats["A"]["first_contact_time"] = None
    lines = rows(result_table({"seats": seats}, everything=False))
    assert ["first contact, after the shutdown, B [s]", "0.5"] in lines
    assert lines[-2:] == [["A", "B"], [FORCE, "1", "2"]]


def test_a_single_seat_needs_no_name() -> None:
    assert rows(result_table({"seats": {"A": {"peak_contact_force": 1.0}}})) == [
        ["largest of the whole run"],
        [FORCE, "1"],
    ]
