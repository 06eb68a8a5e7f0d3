"""Tables by which a stretch of macro steps knows a system: all that is called or copied, by address."""

from __future__ import annotations

import numpy as np


def _table(*fields: str) -> np.dtype:
    """A record of 8-byte integers."""
    return np.dtype([(field, "i8") for field in fields])


TURN = np.dtype(
    [
        ("every", "i8"),  # macro steps of the run that the component takes in one
        ("period", "f8"),  # s, of one that samples: it takes one step from each of its ticks; 0: none
        ("inputs", "i8"),  # address of its inputs
        ("takes", "i8"),  # how many there are
        ("places", "i8"),  # address of their places in the signals
        ("factors", "i8"),  # address of their factors, 0: none is scaled
        ("offsets", "i8"),
        ("first_part", "i8"),  # of PART, that cut the inputs
        ("end_part", "i8"),
        ("taken", "i8"),  # address of what it calls them: words of its memory, or value references
        ("outputs", "i8"),  # address of its part of the signals
        ("gives", "i8"),
        ("given", "i8"),
        ("functions", "i8"),  # whether it has FMI's functions; otherwise, its memory is written and read
        ("of", "i8"),  # address of the component, or of its memory
        ("words", "i8"),  # of the memory
        ("work", "i8"),  # address of scratch
        ("rows", "i8"),
        ("columns", "i8"),
        ("step", "i8"),  # addresses of functions
        ("set_real", "i8"),
        ("get_real", "i8"),
        ("finite", "i8"),  # whether it is to be seen that outputs are finite numbers
        ("end", "i8"),  # of the group that begins with it, whose steps do not depend on each other
        ("shared", "i8"),  # how many of this group are worth a thread
        ("due", "i8"),  # whether it takes the present step
        ("time", "f8"),  # of its last step, s
        ("span", "f8"),
        ("status", "i8"),  # that this had
    ]
)
"""Tables of what each component does in a macro step, in the order of their steps."""

PART = np.dtype(
    [
        *((field, "i8") for field in ("bearing", "body", "means", "slopes", "slope_count", "last")),
        *(("last_count", "i8"), ("step", "f8")),
    ]
)
"""`Part` with its arrays' addresses."""

READ = _table("turn", "call", "of", "references", "count", "into")
"""A call of FMI that fetches values for a recorded row."""

COLUMN = _table("address", "kind")
"""Where a number of a recorded row is found, and of which kind it is."""
REAL, LONG, INT, TRUTH = 0, 1, 2, 3  # the last an int, of which all but 0 is true

PLAN = np.dtype(
    [
        ("at_once", "i8"),  # whether all take their inputs before any steps
        ("board", "i8"),  # address of the one that helpers look at; 0: there are none
        ("start", "f8"),  # of the run, s on the simulation's clock
        ("length", "f8"),  # of a macro step, s
        ("parts", "i8"),  # that each is divided into
        ("impact_parts", "i8"),  # that one is divided into in which a body is hit twice
        ("hit", "i8"),  # how many of those there were
        ("done", "i8"),  # macro steps taken
        ("until", "i8"),  # where the stretch ends
        ("span", "f8"),  # of a part, s
        ("booked", "i8"),  # steps, with the parts of those divided
        ("fall", "f8"),  # J
        ("limit", "f8"),  # share of residual in turnover that ends the stretch
        ("record_every", "i8"),  # macro steps; 0: nothing is recorded
        ("row", "i8"),  # that is filled next
        ("zero", "f8"),  # s, the scene's zero on the simulation's clock
        ("failed", "i8"),  # turn that failed
        ("call", "i8"),  # and at what
        ("status", "i8"),  # what it answered
    ]
)
"""The task of a stretch, and its progress."""
SET, STEP, GET, FETCH = 0, 1, 2, 3  # what a component is called for
NOT_FINITE = 2**40  # status that no function of FMI has: an output is not finite
