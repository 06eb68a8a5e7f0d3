"""What an FMU must answer to the questions in `slave_questions`; calls out of order: `test_wrong_calls`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

ANSWERS: Mapping[str, Any] = {
    "two_instances": {"same": True, "differ": True},
    "fifty_instances": 1,
    "reset": True,
    "saved_early": True,
    "absurd_inputs": [],
    "mixed_types": [],
    "rounded_times": True,
    "begin_anew": True,
    "read_after_the_end": True,
}
TRIED = {"inputs_not_finite": 4, "bad_parameters": 1, "set_too_late": 6, "unknown_references": 3}


def judge(found: Mapping[str, Any]) -> None:
    """Each answer; what was saved replays to the last bit, of a touchdown bearing in contact."""
    assert {name: found[name] for name in ANSWERS} == ANSWERS
    for name, least in TRIED.items():
        assert found[name]["wrong"] == [], name
        tried = found[name]["tried"]
        assert (tried if isinstance(tried, int) else len(tried)) >= least, name
    force = found["replay"].pop("force")
    assert all(found["replay"].values()), found["replay"]
    assert force is None or force > 0.0
    foreign = found["foreign_states"]
    assert foreign["revived"]
    assert [refused for refused, _ in foreign["found"]] == [True] * 5
    assert [said for _, said in foreign["found"] if "not one of this FMU" not in said] == []
    first, second, said = found["failure_lasts"]
    assert (first, second) == (False, False)
    assert "stopped before" in said
