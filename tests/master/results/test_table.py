"""What `touchdown run` shows of a summary: groups, bearings side by side, and what is left to --all."""

from __future__ import annotations

from touchdown.master.results.table import table

SUMMARY = {
    "scene": "two seats",
    "first_contact_time_s_bearing_A": 0.0071,
    "peak_contact_force_N_bearing_A": 545.264,
    "settled_bearing_A": "not settled: swings, decaying",
    "whirl_A": "pendulum",
    "whirl_A_frequency_Hz": None,
    "whirl_A_episodes": [],
    "first_contact_time_s_bearing_B": 0.0072,
    "peak_contact_force_N_bearing_B": None,
    "settled_bearing_B": "settled",
    "something_new": 3,
    "macro_steps": 6000,
    "spread": {"peak_contact_force_N": {}},
}


def test_groups_have_bearings_beside_each_other() -> None:
    lines = [line.split() for line in table(SUMMARY, everything=True).splitlines()]
    at = lines.index(["landing"])
    assert lines[at + 1 : at + 3] == [
        ["bearing_A", "bearing_B"],
        ["first_contact_time_s", "0.0071", "0.0072"],
    ]
    assert ["peak_contact_force_N", "545.264", "-"] in lines
    assert [
        "settled_bearing_A",
        "not",
        "settled:",
        "swings,",
        "decaying",
    ] in lines  # long: a line of its own
    assert (
        lines.index(["others"])
        < lines.index(["something_new", "3"])
        < lines.index(["how", "it", "was", "computed"])
    )
    assert ["whirl_A_episodes", "0"] in lines


def test_every_figure_is_shown_once() -> None:
    text = table(SUMMARY, everything=True)
    for key in set(SUMMARY) - {"spread"}:
        stem = key.removesuffix("_bearing_A").removesuffix("_bearing_B")
        assert text.split().count(stem) + text.split().count(key) * (stem != key) >= 1, key
    assert "spread" not in text


def test_the_short_one_leaves_out_numerics_and_what_did_not_happen() -> None:
    text = table(SUMMARY, everything=False)
    assert "macro_steps" not in text
    assert "frequency" not in text
    row = next(line for line in text.splitlines() if "peak_contact_force_N" in line)
    assert row.split() == ["peak_contact_force_N", "545.264"]
