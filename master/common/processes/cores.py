"""Processors that this process may use."""

from __future__ import annotations

import os


def cores() -> int:
    """How many there are: those it is bound to, or all where the system does not say."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
