"""The right-hand side of the detailed bearings, beside the same arithmetic in vectorised C.

All forces and accelerations of one inner step, by the project's kernels, and by a program written by hand
in C (`in_c/`): structures of arrays, aligned and padded, in plain loops that the compiler turns into vector
code. It may do what the kernels may (`FLAGS`): numbers are added up in the order in which they are written,
and nothing is contracted. It has less to decide: its races are circles, its friction is Makkar's with
g2 = slope, its journal is a point mass.

    python benchmarks/right_hand_side.py [--turns 41] [--flags="-ffast-math"]

First both evaluate states along drops, undamped and damped, with loaded balls in them. Their largest
difference is printed, of a number over itself, of balls' over the largest ball's; above 1e-12 this ends
with an error. Then they take turns in one process, `TIMES` evaluations of a state each in compiled code,
over states of the first impact with nine loaded balls of 17, or three of nine in the cage. Printed are
medians of the turns, and that of their ratios.

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
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from detailed_speed import MODULES, kept, released, repeater

from touchdown.bearings.contact.friction import MAKKAR
from touchdown.bearings.rolling.ball_set import MAX_BALLS
from touchdown.bearings.rolling.micro_step import MICRO_STEP
from touchdown.bearings.rolling.ring import BALLS, LOSS, NEXT
from touchdown.bearings.seat import JX
from touchdown.modelkit.instance import Instance

SOURCE = Path(__file__).with_name("in_c") / "right_hand_side.c"
FLAGS = "-std=c11 -O3 -march=native -ffp-contract=off -fno-math-errno -fno-trapping-math"
LIMIT = 1e-12  # of the difference
STATES, TIMED = 60, 5  # of a drop that are compared, and timed
TIMES = 4000  # evaluations of a state in a turn
STRETCH, IMPACT, DROP = 1e-5, 1.3e-3, 4e-3  # s, from state to state; to the end of the first impact; in all
DAMPED = 0.05  # damping ratio of the balls


class Case(NamedTuple):
    """A bearing, and which of its states are compared and timed."""

    name: str
    side: str  # group of the law between a ball and what touches it beside
    compared: range  # loaded balls
    timed: int  # loaded balls

    @property
    def module(self) -> ModuleType:
        """The model."""
        return MODULES[self.name]


CASES = (
    Case("cageless", "ball", range(3, 13), 9),
    Case("caged", "cage", range(1, 10), 3),
)


def numbers(names: str, size: int = 1) -> np.dtype:
    """A record of numbers, or of arrays of `size` numbers."""
    return np.dtype([(name, "f8", size) if size > 1 else (name, "f8") for name in names.split()])


# The structs of in_c/bearing.h.
STATE = np.dtype([("head", "f8", 32), ("cage", "f8", 8), ("balls", "f8", (6, MAX_BALLS))])
RACE = numbers(
    "normal tangential indentation stiffness loss nx ny second sliding rate damped driven expected "
    "start slope base held gain middle stored",
    MAX_BALLS,
)
SIDE = numbers(
    "normal highest tangential indentation stiffness nx ny first second sliding rate damped middle stored",
    MAX_BALLS,
)
CHAIN = numbers("elastic driven across base pull free", MAX_BALLS)
LINES = numbers("normal sliding expected answer spot last flat start slope base", 2 * MAX_BALLS)
LAW, FRICTION = numbers("stiffness damping dissipation viscous"), numbers("g1 g2 g3 dynamic slope g6")
BEARING = np.dtype(
    [
        *[("inner", RACE), ("outer", RACE), ("side", SIDE), ("chain", CHAIN), ("lines", LINES)],
        *[("faster", numbers("x y spin", MAX_BALLS)), ("cross", "f8", MAX_BALLS)],
        *numbers("pocket_x pocket_y", MAX_BALLS).descr,
        ("before", STATE),
        *[("kick", "f8"), ("drift", "f8"), ("rubbed", "f8"), ("ahead", "f8", 5), ("half", "f8")],
        *[
            ("ring", numbers("normal indentation rate elastic middle nx ny stored")),
            ("brake", numbers("jx jy jm hx hy")),
        ],
        *numbers("gravity journal_radius clearance ring_mass ring_inertia").descr,
        *numbers("mass inertia ball_radius inner_radius outer_radius").descr,
        *numbers("cage_mass cage_inertia cage_clearance").descr,
        *[(name, LAW) for name in ("inner_law", "outer_law", "contact", "side_contact")],
        *[(name, FRICTION) for name in ("friction", "race_friction", "side_friction")],
        ("journal", numbers("ax_free ay_free inv_m alpha_free inv_I")),
        ("housing", numbers("x y vx vy ax_free ay_free inv_m k_over_m c_over_m")),
        *[("count", "i8"), ("caged", "i8")],
    ]
)
GIVEN = {  # by group of the project's memory, what goes by the same name in both
    "s": "inner outer side kick drift rubbed ahead ring",
    "d": "mass inertia ball_radius inner_radius outer_radius contact friction race_friction",
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
    """Set the field of that `name` in the record `to`; of a record or array, all that it has room for."""
    if to.dtype[name].names:
        for field in to.dtype[name].names:
            copy(field, to[name], given[name])
    else:
        room = to.dtype[name].shape
        to[name] = given[name][: room[0]] if room else given[name]


def lay_out(to: Any, vector: np.ndarray, count: int) -> None:
    """Set a STATE to the project's; the first ball stands in where there are no more."""
    cage = BALLS + 6 * count  # what lies there without one is as good as nothing
    balls = vector[BALLS:cage].reshape(6, count)
    head = np.concatenate((vector[: LOSS + 1], vector[JX:NEXT]))
    to["head"][: len(head)], to["cage"][:6] = head, vector[cage : cage + 6]
    to["balls"][:], to["balls"][:, :count] = balls[:, :1], balls


class InC:
    """The C program on the state of a bearing. Ends where that has what the program has not."""

    def __init__(self, program: ctypes.CDLL, instance: Instance) -> None:
        self.bearing, self.state, self.slope = aligned(BEARING), aligned(STATE), aligned(STATE)
        self._take(instance.record)
        given = (self.state, self.slope, self.bearing)
        self._at = [ctypes.c_void_p(one.__array_interface__["data"][0]) for one in given]
        self._repeat = program.repeat

    def _take(self, r: Any) -> None:
        """Take constants and state from the project's memory."""
        m, p, d, caged = self.bearing, r["p"], r["d"], "cage" in r["p"].dtype.names
        side = "cage" if caged else "ball"
        laws = [d[name] for name in ("friction", "race_friction", f"{side}_friction")]
        if d["searched"] or any(law["kind"] != MAKKAR or law["g2"] != law["slope"] for law in laws):
            raise SystemExit("the C program has circles for races, and Makkar's friction with g2 = slope")
        for group, names in GIVEN.items():
            for name in names.split():
                copy(name, m, r[group])
        copy("inner_law", m, {"inner_law": d["inner"]})
        copy("outer_law", m, {"outer_law": d["outer"]})
        copy("side_contact", m, {"side_contact": d[f"{side}_contact"]})
        copy("side_friction", m, {"side_friction": d[f"{side}_friction"]})
        m["ring_mass"], m["ring_inertia"] = p["ring"]["mass"], p["ring"]["inertia"]
        m["half"], m["count"], m["caged"] = r["half"], p["balls"]["count"], caged
        if caged:
            m["cage_mass"], m["cage_clearance"] = p["cage"]["mass"], p["cage"]["clearance"]
            for name in ("cage_inertia", "pocket_x", "pocket_y"):
                m[name] = d[name]
        lay_out(self.state, r["q"], int(m["count"]))
        lay_out(m["before"], r["s"]["before"], int(m["count"]))

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


class Pair(NamedTuple):
    """Both on one state."""

    in_c: InC
    kernels: Kernels

    def difference(self) -> float:
        """The largest in what both found."""
        theirs, ours, count = self.in_c, self.kernels, self.kernels.count
        pairs = list(zip(theirs.slope["head"], ours.slope["head"], strict=True))
        pairs += zip(theirs.slope["cage"], ours.slope["cage"], strict=True)
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


def landed(case: Case, ratio: float) -> Instance:
    """The bearing at first touch, with a damping ratio of all contacts of balls."""
    instance = released(case.module)
    for group in ("balls", f"{case.side}_contact"):
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


def pair(case: Case, state: Seen, program: ctypes.CDLL, repeat: Callable) -> Pair:
    """Both on a state of a drop."""
    instance = Instance(case.module.MODEL)
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


def compared(case: Case, program: ctypes.CDLL, turns: int) -> Comparison:
    """Both on states of drops, then by turns on those with so many loaded balls as are to be timed."""
    repeat, carry = repeater(case.module), kept(case.module)
    off, timed = [], []
    for ratio in (0.0, DAMPED):
        seen = drop(landed(case, ratio), carry)
        for state in evenly([one for one in seen if one.loaded in case.compared], STATES):
            both = pair(case, state, program, repeat)
            for one in both:
                one.evaluate(1)
            off.append(both.difference())
        if not ratio:
            timed = evenly([one for one in seen if one.loaded == case.timed and one.time < IMPACT], TIMED)
    pairs = [pair(case, state, program, repeat) for state in timed]
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
        program = library(flags, Path(folder))
        found = {case: compared(case, program, options.turns) for case in CASES}
    print(
        f"C compiled with {flags}; states compared: {', '.join(str(one.states) for one in found.values())}"
    )
    print(f"{'bearing':<20}{'loaded balls':>14}{'C':>12}{'project':>12}{'ratio':>8}{'difference':>12}")
    for case, one in found.items():
        times = f"{one.in_c * 1e6:>9.3f} us{one.kernels * 1e6:>9.3f} us"
        print(
            f"{'detailed, ' + case.name:<20}{case.timed:>14}{times}{one.ratio:>8.2f}{one.difference:>12.1g}"
        )
    if not all(one.difference <= LIMIT for one in found.values()):
        print(f"they do not compute the same: a difference is above {LIMIT:g}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
