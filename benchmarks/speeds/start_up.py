"""A command's start: with an empty cache and with a full one, its memory, and the sizes of FMUs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from speeds.measured import Block, spread
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.components.loading import built

WAYS = {"in process": ["--in-process"], "native FMUs": ["--native"], "FMUs in Python": []}
# A process that is small itself: what one starts counts the memory of who started it as its own.
WATCH = """
import json, os, subprocess, sys, time
began = time.perf_counter()
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, used = os.wait4(process.pid, 0)
wall = time.perf_counter() - began
print(json.dumps([os.waitstatus_to_exitcode(status), wall, used.ru_utime + used.ru_stime, used.ru_maxrss]))
"""
BRIEF = ["--set", "run.duration=1 ms", "--no-pictures", "--quiet"]


@dataclass(frozen=True)
class Start:
    """What a command took that steps a scene for a moment."""

    wall: float  # s
    processor: float  # s, of all its processes
    memory: float  # MB, the most at once of one process


def started(scene: str, way: str, environment: dict[str, str]) -> Start:
    """One command. Raises CalledProcessError where it fails."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "touchdown", "run", scene, *BRIEF, *WAYS[way], "-o", folder]
        watched = [sys.executable, "-c", WATCH, *command]
        said = subprocess.run(watched, env=environment, stdout=subprocess.PIPE, check=True).stdout
    status, wall, processor, memory = json.loads(said)
    if status:
        raise subprocess.CalledProcessError(status, command)
    return Start(wall, processor, memory / 1024.0)


def block(scene: str, repeat: int, native: bool, cold: bool) -> Block:
    """Rows of starts with the cache as it is; `cold`: also with one that holds nothing."""
    rows: list[tuple[str, ...]] = []
    for way in (way for way in WAYS if native or way != "native FMUs"):
        if cold:
            with tempfile.TemporaryDirectory() as empty:
                first = started(scene, way, {**os.environ, "TOUCHDOWN_CACHE": str(Path(empty, "cache"))})
            rows.append(_row(f"{way}, empty cache", [first]))
        started(scene, way, dict(os.environ))  # fills it
        rows.append(
            _row(f"{way}, full cache", [started(scene, way, dict(os.environ)) for _ in range(repeat)])
        )
    return Block(
        f"touchdown run {scene}, up to 1 ms", ("cache", "wall", "processor", "memory"), tuple(rows)
    )


def _row(name: str, starts: list[Start]) -> tuple[str, ...]:
    wall, processor = (spread([getattr(s, what) for s in starts]).text for what in ("wall", "processor"))
    return name, f"{wall} s", f"{processor} s", f"{max(s.memory for s in starts):.0f} MB"


def sizes(native: bool) -> Block:
    """Rows of the FMUs' sizes."""
    kinds = {"in Python": False, "native": True} if native else {"in Python": False}
    rows = [
        (name, *(f"{built(recipe(name), kind).stat().st_size / 1e3:.0f} kB" for kind in kinds.values()))
        for name in fmu_names()
    ]
    return Block("size of FMUs", ("FMU", *kinds), tuple(rows))
