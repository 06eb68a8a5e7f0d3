"""The right-hand side of the detailed cageless bearing, beside the same arithmetic in vectorised C.

All forces and accelerations of one inner step, by the project's kernels, and by a program written by hand
in C (`in_c/`): structures of arrays, aligned and padded, in plain loops that the compiler turns into vector
code. It may do what the kernels may (`FLAGS`): numbers are added up in the order in which they are written,
and nothing is contracted. It has less to decide: its races are circles, its friction is Makkar's with
g2 = slope, its journal is a point mass.

    python benchmarks/right_hand_side.py [--turns 41] [--flags="-ffast-math"]

First both evaluate states along drops, undamped and damped, with 3 to 12 loaded balls. Their largest
difference is printed, of a number over itself, of balls' over the largest ball's; above 1e-12 this ends
with an error. Then they take turns in one process, `TIMES` evaluations of a state each in compiled code,
over states of the first impact with nine loaded balls. Printed are medians of the turns, and that of their
ratios.

It takes a C compiler: CC, cc or gcc. What `--flags` says comes behind `FLAGS`.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from detailed_speed import MODULES, kept, released
from tried_integrators import whole

from touchdown.bearings.contact.friction import MAKKAR
from touchdown.bearings.rolling.ball_state import BALLS
from touchdown.bearings.rolling.balls import MOST_BALLS
from touchdown.bearings.rolling.micro_step import COPIES, MICRO_STEP
from touchdown.modelkit.instance import Instance

SOURCE = Path(__file__).with_name("in_c") / "right_hand_side.c"
FLAGS = "-std=c11 -O3 -march=native -ffp-contract=off -fno-math-errno -fno-trapping-math"
LIMIT = 1e-12  # of the difference
LOADED = range(3, 13)  # balls, in states that are compared
NINE = 9  # loaded balls, in those that are timed
STATES, TIMED = 60, 5  # of a drop that are compared, and timed
TIMES = 4000  # evaluations of a state in a turn
STRETCH, IMPACT, DROP = 1e-5, 1.3e-3, 4e-3  # s, from state to state; to the end of the first impact; in all
DROPS = ({}, {"balls": 0.05, "ball_contact": 0.05})  # damping ratios


def numbers(names: str, size: int = 1) -> np.dtype:
    """A record of numbers, or of arrays of `size` numbers."""
    return np.dtype([(name, "f8", size) if size > 1 else (name, "f8") for name in names.split()])


# The structs of in_c/bearing.h.
STATE = np.dtype([("head", "f8", 32), ("balls", "f8", (6, MOST_BALLS))])
RACE = numbers(
    "normal tangential indentation stiffness loss nx ny second sliding rate damped driven expected "
    "start slope base held gain",
    MOST_BALLS,
)
SIDE = numbers(
    "normal highest tangential indentation stiffness nx ny first second sliding rate damped", MOST_BALLS
)
CHAIN = numbers("elastic driven across base pull free", MOST_BALLS)
LINES = numbers("normal sliding expected answer spot last flat start slope base", 2 * MOST_BALLS)
LAW, FRICTION = numbers("stiffness damping dissipation viscous"), numbers("g1 g2 g3 dynamic slope g6")
BEARING = np.dtype(
    [
        *[("inner", RACE), ("outer", RACE), ("side", SIDE), ("chain", CHAIN), ("lines", LINES)],
        *[("faster", numbers("x y spin", MOST_BALLS)), ("cross", "f8", MOST_BALLS), ("before", STATE)],
        *[("kick", "f8"), ("rubbed", "f8"), ("ahead", "f8", len(COPIES)), ("half", "f8")],
        *[("ring", numbers("normal indentation rate elastic")), ("brake", numbers("jx jy jm hx hy"))],
        *numbers("gravity journal_radius clearance ring_mass ring_inertia").descr,
        *numbers("mass inertia ball_radius inner_radius outer_radius").descr,
        *[(name, LAW) for name in ("inner_law", "outer_law", "contact", "ball_contact")],
        *[(name, FRICTION) for name in ("friction", "race_friction", "ball_friction")],
        ("journal", numbers("ax_free ay_free inv_m alpha_free inv_I")),
        ("housing", numbers("x y vx vy ax_free ay_free inv_m k_over_m c_over_m")),
        ("count", "i8"),
    ]
)
GIVEN = {  # by group of the project's memory, what goes by the same name in both
    "s": "inner outer side chain faster cross kick rubbed ahead ring brake",
    "d": "mass inertia ball_radius inner_radius outer_radius contact ball_contact "
    "friction race_friction ball_friction",
    "p": "gravity journal_radius clearance",
    "u": "journal housing",
}
FOUND = {  # what is compared, beside the derivative of the state
    "inner": "normal tangential indentation stiffness loss",
    "outer": "normal tangential indentation stiffness loss",
    "side": "normal highest tangential indentation stiffness",
    "ring": "normal indentation rate elastic",
    "brake": "jx jy jm hx hy",
}


def library(flags: str, folder: Path) -> ctypes.CDLL:
    """The C program, compiled in a `folder`. Ends with one line where that cannot be."""
    found = shutil.which("cc") or shutil.which("gcc")
    compiler = shlex.split(os.environ.get("CC", "")) or ([found] if found else [])
    if not compiler:
        raise SystemExit("there is no C compiler (cc, gcc, or what CC says): nothing to compare with")
    path = folder / "right_hand_side.so"
    command = [*compiler, *shlex.split(flags), "-shared", "-fPIC", "-o", str(path), str(SOURCE), "-lm"]
    try:
        subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit(f"the C program does not compile: {error}") from None
    loaded = ctypes.CDLL(str(path))
    assert loaded.size_of_bearing() == BEARING.itemsize
    return loaded


def aligned(layout: np.dtype) -> Any:
    """A record of zeros that begins where the widest vector may."""
    room = np.zeros(layout.itemsize + 63, "u1")
    begin = -room.ctypes.data % 64
    return room[begin : begin + layout.itemsize].view(layout)[0]


def copy(name: str, to: Any, given: Any) -> None:
    """Set the field of that `name` in the record `to`; of a record, all that it has a place for."""
    if to.dtype[name].names:
        for field in to.dtype[name].names:
            copy(field, to[name], given[name])
    else:
        to[name] = given[name]


def lay_out(to: Any, vector: np.ndarray, count: int) -> None:
    """Set a STATE to the project's state vector; the first ball stands in where there are no more."""
    balls = vector[BALLS : BALLS + 6 * count].reshape(6, count)
    to["head"][:BALLS], to["balls"][:], to["balls"][:, :count] = vector[:BALLS], balls[:, :1], balls


class InC:
    """The C program on the state of a bearing. Ends where that has what the program has not."""

    def __init__(self, program: ctypes.CDLL, instance: Instance) -> None:
        r, m = instance.record, aligned(BEARING)
        laws = [r["d"][name] for name in ("friction", "race_friction", "ball_friction")]
        if r["d"]["searched"] or any(f["kind"] != MAKKAR or f["g2"] != f["slope"] for f in laws):
            raise SystemExit("the C program has circles for races and Makkar's friction with g2 = slope")
        for group, names in GIVEN.items():
            for name in names.split():
                copy(name, m, r[group])
        for side in ("inner", "outer"):
            for name in LAW.names or ():
                m[f"{side}_law"][name] = r["d"][side][name]
        m["ring_mass"], m["ring_inertia"] = r["p"]["ring"]["mass"], r["p"]["ring"]["inertia"]
        m["half"], m["count"] = r["half"], r["p"]["balls"]["count"]
        self.bearing, self.state, self.slope = m, aligned(STATE), aligned(STATE)
        lay_out(self.state, r["q"], int(m["count"]))
        lay_out(m["before"], r["s"]["before"], int(m["count"]))
        self._repeat = program.repeat
        self._at = [
            ctypes.c_void_p(one.__array_interface__["data"][0]) for one in (self.state, self.slope, m)
        ]

    def evaluate(self, times: int) -> None:
        """The right-hand side, `times` over."""
        self._repeat(*self._at, ctypes.c_int64(times))


class Kernels:
    """The project's right-hand side, compiled as it is in the models, on the state of a bearing."""

    def __init__(self, repeat: Callable, instance: Instance) -> None:
        self.record, self._words, self._repeat = instance.record, instance.words, repeat
        self._rows = np.zeros((8, len(self.record["q"])))
        self.count = int(self.record["p"]["balls"]["count"])

    def evaluate(self, times: int) -> None:
        """The right-hand side, `times` over."""
        self._repeat(self._words, self._rows, times)

    @property
    def slope(self) -> Any:
        """The state's derivative, a STATE."""
        slope = aligned(STATE)
        lay_out(slope, self._rows[0], self.count)
        return slope


def repeater() -> Callable:
    """A kernel repeat(words, rows, times) that evaluates the bearing's right-hand side `times` over."""
    module = MODULES["cageless"]
    rhs, memory, scratch = module.rhs, module.MEMORY, module.SCRATCH

    @whole
    def repeat(words, rows, times):
        m = words.view(memory)[0]
        dq = rows.ravel().view(scratch)[0].rows[0]
        for _ in range(times):
            rhs(0.0, m.q, dq, m)

    return repeat


class Pair(NamedTuple):
    """Both on one state."""

    in_c: InC
    kernels: Kernels

    def difference(self) -> float:
        """The largest in what both found."""
        theirs, ours, count = self.in_c, self.kernels, self.kernels.count
        pairs = list(zip(theirs.slope["head"], ours.slope["head"], strict=True))
        pairs += zip(theirs.slope["balls"][:, :count], ours.slope["balls"][:, :count], strict=True)
        for group, names in FOUND.items():
            for name in names.split():
                of_balls = slice(count) if theirs.bearing[group].dtype[name].shape else ()
                pairs.append(tuple(of[group][name][of_balls] for of in (theirs.bearing, ours.record["s"])))
        return max(apart(one, other) for one, other in pairs)


def apart(one: Any, other: Any) -> float:
    """Largest difference of numbers over the largest of them; infinite where one is not a number."""
    off, size = float(np.max(np.abs(one - other))), float(np.max(np.abs(other)))
    return 0.0 if off == 0.0 else off / size if off < np.inf and size > 0.0 else np.inf


def loaded(instance: Instance) -> int:
    """Balls that both races press."""
    count, s = int(instance.record["p"]["balls"]["count"]), instance.record["s"]
    return int(np.sum((s["inner"]["normal"][:count] > 0.0) & (s["outer"]["normal"][:count] > 0.0)))


def landed(damping: dict[str, float]) -> Instance:
    """The bearing at first touch, with damping ratios by group of its parameters."""
    instance = released(MODULES["cageless"])
    for group, ratio in damping.items():
        instance.record["p"][group]["damping_ratio"] = ratio
    instance.start(0.0)
    return instance


class Seen(NamedTuple):
    """A state along a drop: the bearing's memory."""

    time: float  # s, from first touch
    loaded: int  # balls
    words: np.ndarray


def drop(instance: Instance, carry: Callable) -> list[Seen]:
    """States along its drop, `STRETCH` apart; carry: as `detailed_speed.kept` makes it."""
    found, rows = [], np.zeros((8, len(instance.record["q"])))
    for k in range(round(DROP / STRETCH)):
        carry(instance.words, rows, STRETCH, MICRO_STEP, 0.0)
        found.append(Seen((k + 1) * STRETCH, loaded(instance), instance.words.copy()))
    return found


def evenly(states: list[Seen], count: int) -> list[Seen]:
    """Some `count` of the `states`, from first to last."""
    return [states[round(i)] for i in np.linspace(0, len(states) - 1, count)]


def pair(state: Seen, damping: dict[str, float], program: ctypes.CDLL, repeat: Callable) -> Pair:
    """Both on a state of a drop."""
    instance = landed(damping)
    instance.words[:] = state.words
    return Pair(InC(program, instance), Kernels(repeat, instance))


def turn(pairs: list[Pair], order: int) -> tuple[float, float]:
    """s per evaluation of the C program and of the kernels, one behind the other; order: 1 or -1."""
    spent = [0.0, 0.0]
    for both in pairs:
        for who in (0, 1)[::order]:
            began = clock.perf_counter()
            both[who].evaluate(TIMES)
            spent[who] += (clock.perf_counter() - began) / (TIMES * len(pairs))
    return spent[0], spent[1]


class Comparison(NamedTuple):
    """What came of both."""

    in_c: float  # s, of an evaluation
    kernels: float  # s
    ratio: float
    difference: float
    states: int  # in which that is the largest


def compared(program: ctypes.CDLL, turns: int) -> Comparison:
    """Both on states of drops, then by turns on those with nine loaded balls."""
    repeat, carry = repeater(), kept(MODULES["cageless"])
    off, timed = [], []
    for damping in DROPS:
        seen = drop(landed(damping), carry)
        for state in evenly([one for one in seen if one.loaded in LOADED], STATES):
            both = pair(state, damping, program, repeat)
            for one in both:
                one.evaluate(1)
            off.append(both.difference())
        if not damping:
            timed = evenly([one for one in seen if one.loaded == NINE and one.time < IMPACT], TIMED)
    pairs = [pair(state, {}, program, repeat) for state in timed]
    turn(pairs, 1)
    costs = [turn(pairs, (1, -1)[k % 2]) for k in range(turns)]
    off += [both.difference() for both in pairs]  # they went the same way ever since
    in_c, kernels = (statistics.median(times) for times in zip(*costs, strict=True))
    ratio = statistics.median(ours / theirs for theirs, ours in costs)
    return Comparison(in_c, kernels, ratio, max(off), len(off))


def main(arguments: list[str] | None = None) -> int:
    """Print the table; 1: what they find differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--turns", type=int, default=41)
    parser.add_argument("--flags", default="", help="more of them for the C compiler")
    options = parser.parse_args(arguments)
    flags = f"{FLAGS} {options.flags}".strip()
    with tempfile.TemporaryDirectory() as folder:
        found = compared(library(flags, Path(folder)), options.turns)
    print(f"C compiled with {flags}; {found.states} states compared")
    print(f"{'bearing':<20}{'loaded balls':>14}{'C':>12}{'project':>12}{'ratio':>8}{'difference':>12}")
    times = f"{found.in_c * 1e6:>9.3f} us{found.kernels * 1e6:>9.3f} us"
    print(f"{'detailed, cageless':<20}{NINE:>14}{times}{found.ratio:>8.2f}{found.difference:>12.1g}")
    if not found.difference <= LIMIT:
        print(f"they do not compute the same: the difference is above {LIMIT:g}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
