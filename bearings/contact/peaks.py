"""Peaks of contacts: the largest force and indentation, also where they lie between two micro-steps.

A light body on a stiff contact may swing by h w = 0.8 in a step (`modelkit.integrators.verlet`), and the
largest of such samples is up to 8 % below the extremum. So the parabola through the last three stands for
the motion where the middle one is the largest: of a Hertz contact that leaves at most 0.1 % at h w = 0.4,
0.6 % at 0.6 and 1.7 % at 0.8, less than half of it on the average. A force that begins or ends within the
three, or that moves from one ball to another, is not a parabola, and the samples count.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.variables import group, integer, real

# Of the step before; over less than that, as at the end of a macro step, no slope is taken
MIN_STEP_RATIO = 0.1


@dataclass(frozen=True)
class Samples:
    """The last two samples of a force (N) or an indentation (m), and at which contact they were."""

    time_before: float = real(-1.0, "s", "time of the last sample but one; -1: there was none")
    before: float = real(0.0, "1", "the last sample but one, in the unit of what is watched")
    place_before: int = integer(0, "number of its contact")
    time: float = real(-1.0, "s", "time of the last sample; -1: there was none")
    last: float = real(0.0, "1", "the last sample, in the same unit")
    place: int = integer(0, "number of its contact")


@dataclass(frozen=True)
class PeakMemory:
    """Samples of one kind of contact."""

    force: Samples = group(Samples)
    indentation: Samples = group(Samples)


class Largest(NamedTuple):
    """The most loaded and the most indented of contacts of one kind."""

    force: float  # N
    indentation: float  # m
    loaded: int  # which bears the force
    deepest: int  # which has the indentation


@kernel
def vertex(samples, time, value):
    """Largest value of the parabola through both `samples` and `value` at `time` (s), in their unit.

    For a middle sample that is the largest, so that the vertex lies between the outer ones.
    """
    first, second = samples.time - samples.time_before, time - samples.time
    rise, fall = (samples.last - samples.before) / first, (value - samples.last) / second
    slope = (rise * second + fall * first) / (first + second)  # at the middle sample
    return samples.last + 0.25 * slope * slope * (first + second) / (rise - fall)


@kernel
def crest(samples, time, value, place):
    """The largest that a quantity has been since the last sample but one, as far as three samples tell.

    value: its sample (N or m; zero or less: apart) at `time` (s) in the contact number `place`, which takes
    its place in the record `samples` (`Samples`).
    """
    top = value
    if samples.time_before < 0.0 or time - samples.time > MIN_STEP_RATIO * (
        samples.time - samples.time_before
    ):
        same = samples.place_before == samples.place and samples.place == place
        if same and samples.last > samples.before > 0.0 and samples.last >= value > 0.0:
            top = vertex(samples, time, value)
        samples.time_before, samples.before = samples.time, samples.last
        samples.place_before = samples.place
    samples.time, samples.last, samples.place = time, value, place
    return top


@kernel
def watch_peaks(time, largest, report, memory):
    """Keep the peaks of a kind of contact in `report` (peak_force in N, peak_indentation in m).

    Called after each accepted micro-step with the `largest` (`Largest`); memory: a record of
    `PeakMemory`. Returns the largest force since the last step but one (N).
    """
    force = crest(memory.force, time, largest.force, largest.loaded)
    depth = crest(memory.indentation, time, largest.indentation, largest.deepest)
    if force > report.peak_force:
        report.peak_force = force
    if depth > report.peak_indentation:
        report.peak_indentation = depth
    return force
