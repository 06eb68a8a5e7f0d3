"""Processors that this process may use, and threads that a run may have."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

LIMIT = "OMP_NUM_THREADS"  # an environment variable; parallel libraries keep to it, too
QUOTA = Path("/sys/fs/cgroup/cpu.max")  # of processor time, in a container


def cores() -> int:
    """How many there are: those it is bound to, or all where the system does not say."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads() -> int:
    """How many threads a run may have."""
    given = os.environ.get(LIMIT, "").partition(",")[0]
    if given.strip().isdecimal() and int(given) > 0:
        return int(given)
    found = cores()
    with suppress(OSError, ValueError):
        quota, period = map(float, QUOTA.read_text().split())
        found = min(found, int(quota / period))
    return max(found, 1)
