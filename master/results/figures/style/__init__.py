"""What the pictures share: colours, their look on light and dark ground, and lines that can be read."""

from touchdown.master.results.figures.style.curves import (
    LAST,
    MOST_POINTS,
    TIME,
    WIDTH,
    Curve,
    beginning,
    present,
    thinned,
    within,
    zooms,
)
from touchdown.master.results.figures.style.dark import darkened
from touchdown.master.results.figures.style.look import drawable, roomy, sheet, sized, styled
from touchdown.master.results.figures.style.palette import (
    BLACK,
    BLUE,
    COLOURS,
    GREEN,
    GREY,
    ON_DARK,
    ORANGE,
    PURPLE,
    SKY,
    YELLOW,
)

__all__ = [
    "BLACK",
    "BLUE",
    "COLOURS",
    "GREEN",
    "GREY",
    "LAST",
    "MOST_POINTS",
    "ON_DARK",
    "ORANGE",
    "PURPLE",
    "SKY",
    "TIME",
    "WIDTH",
    "YELLOW",
    "Curve",
    "beginning",
    "darkened",
    "drawable",
    "present",
    "roomy",
    "sheet",
    "sized",
    "styled",
    "thinned",
    "within",
    "zooms",
]
