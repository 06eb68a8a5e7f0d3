"""Colours of the pictures, to be told apart by everyone, on light and on dark ground.

They are those of Okabe and Ito (Color Universal Design, 2008), and a grey. On dark ground each has a
lighter one in its place; greys keep their distance from the ground.
"""

from __future__ import annotations

from collections.abc import Mapping

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#666666"
SKY, YELLOW, BLACK, WHITE = "#56b4e9", "#e69f00", "#000000", "#ffffff"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, GREY)

DARK = "#16191d"  # the dark ground
LIGHT_INK = "#e8eaed"  # text and axes on it
ON_DARK: Mapping[str, str] = {
    BLUE: SKY,
    ORANGE: "#f0803c",
    GREEN: "#2fc79b",
    PURPLE: "#dd9fc2",
    GREY: "#7a7f85",
    SKY: "#9bd3f5",
    YELLOW: "#f5c451",
    BLACK: LIGHT_INK,
    WHITE: DARK,
}
"""Of a colour on light ground the one on dark ground."""
