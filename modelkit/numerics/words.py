"""A memory as plain words: set to zero, and looked through for what is not a number."""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import kernel


@kernel
def blank(words, constants):
    """Set error weights, constants and what was told of a problem to zero.

    words: the memory (float64); constants: where they lie (`modelkit.model.constants`).
    """
    for i in range(constants[1], len(words)):
        words[i] = 0.0


@kernel
def missing(words, constants):
    """Number of the text that names the first constant that is not a finite number; 0: all are.

    words: the memory (float64); constants: where they lie (`modelkit.model.constants`). A count is found
    finite: as a float its bits are a tiny number.
    """
    for k in range(2, len(constants)):
        for i in range(constants[k - 1], constants[k]):
            if not math.isfinite(words[i]):
                return constants[0] + k - 1
    return 0
