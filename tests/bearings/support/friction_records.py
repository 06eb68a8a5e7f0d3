"""Friction laws as the kernels of a bearing derive them, and room for what comes of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from touchdown.bearings.contact.friction import FrictionLaw, derive
from touchdown.bearings.rolling.friction import FrictionLines
from touchdown.modelkit.variables import as_record, layout


def prepared(law: FrictionLaw) -> Any:
    """The record of a law, with g1 filled in where it is left open."""
    record = as_record(law)
    derive(record)
    return record


def unwritten_lines() -> Any:
    """A record of `FrictionLines`, full of what is not a number."""
    kept = layout(FrictionLines)
    return np.full(kept.itemsize // 8, np.nan).view(kept).view(np.recarray)[0]
