"""Friction laws as the kernels of a bearing settle them."""

from __future__ import annotations

from typing import Any

from touchdown.bearings.contact.friction import FrictionLaw, settle
from touchdown.modelkit.variables import as_record


def prepared(law: FrictionLaw) -> Any:
    """The record of a law, with g1 filled in where it is left open."""
    record = as_record(law)
    settle(record)
    return record
