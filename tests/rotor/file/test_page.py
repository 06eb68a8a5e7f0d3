"""The page of the rotor file has every key that the reader knows, and its example is one."""

from __future__ import annotations

import re
from pathlib import Path

from touchdown.modelkit.reader import kinds
from touchdown.rotor.beams.beam_body import PointMass
from touchdown.rotor.beams.shaft import Shaft, Support, Unbalance
from touchdown.rotor.file import parse_rotor, parser

PAGE = (Path(__file__).parents[3] / "docs" / "rotor-file.md").read_text(encoding="utf-8")


DECLARED = (
    *(parser.Material, parser.Core, parser.Sleeve, parser.Layer, parser.Disc, parser.GapAt, parser.Blocks),
    *(PointMass, Shaft, Support, Unbalance),
)


def test_every_key_is_there() -> None:
    keys = {*parser.OTHERS, *(name for declared in DECLARED for name in kinds(declared))}
    assert {"levitated_at", "shear_factor", "damping_y", "shapes"} <= keys
    assert {key for key in keys if not re.search(rf"[`\[.]{key}[`\].]", PAGE)} == set()


def test_its_example_is_a_rotor() -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert parse_rotor(text, "stub.toml").mass > 0.5
