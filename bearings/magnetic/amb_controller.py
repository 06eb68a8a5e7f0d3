"""Controller of one or two magnetic bearings: a sampled PID per channel, shutdown and re-levitation.

A channel is an axis of a bearing or, for two bearings on one rotor (axes 1 and 2 of the first, 3 and 4 of
the second), the translation or the tilt that both see along one direction: half the sum and half the
difference of their positions. With equal gains both structures are the same.

`levitation` says when it acts. It begins with what holds the static load as its integral.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.variables import Choices, choice, group, groups, real
from . import law, levitation
from .levitation import AXES, Inputs, Outputs

CLOCKS = Choices("Clock", ("tick", "own"), ("the bearing's samples", "its own, at ends of macro steps"))
STRUCTURES = Choices(
    "Structure",
    ("decentralised", "translation_tilt"),
    ("each axis by itself", "translation and tilt of two bearings: channels 1 and 2, 3 and 4"),
)


@dataclass(frozen=True)
class Parameters(levitation.Parameters):
    """For the 1.65 kg of a disk on 26 N/A and -79 kN/m."""

    structure: int = choice(0, STRUCTURES, "what a channel is")
    gain: law.Gain = group(law.Gain)
    channel: tuple = groups(law.Channel, AXES)
    clock: int = choice(0, CLOCKS, "whose samples are used")
    sample_time: float = real(
        1e-4, "s", "from sample to sample by its own clock", above=0.0, needs="clock == 1"
    )


@dataclass(frozen=True)
class Hidden(levitation.Hidden):
    """Memory from sample to sample."""

    channel: tuple = groups(law.ChannelMemory, AXES)


MEMORY = memory_layout(Parameters, Inputs, Outputs, 1, hidden=Hidden)


@kernel
def mixed(a, b, factor, m):
    """Two bearings' values along one direction as those of two channels (factor 1/2), and back (1)."""
    if m.p.structure == 0:
        return a, b
    return factor * (a + b), factor * (a - b)


@kernel
def _begin_channels(m):
    """Begin all channels anew at the measured positions, with what holds the static load."""
    u, z = m.u.axis, m.s.channel
    for k in range(2):
        y1, y2 = mixed(u[k].sensed, u[k + 2].sensed, 0.5, m)
        hold1, hold2 = mixed(u[k].hold, u[k + 2].hold, 0.5, m)
        law.begin_channel(z[k], y1, hold1)
        law.begin_channel(z[k + 2], y2, hold2)


@kernel
def derive(words):
    """The state has one component, which does not move. Returns 0: nothing can be wrong."""
    m = words.view(MEMORY)[0]
    m.n = 1
    m.weight[0] = 0.0
    return 0


@kernel
def _answer_samples(lead, period, m):
    """As `levitation` has it."""
    p, u, s = m.p, m.u.axis, m.s
    for k in range(2):
        one, other = s.channel[k], s.channel[k + 2]
        one.position, other.position = mixed(u[k].sensed, u[k + 2].sensed, 0.5, m)
        law.update(one, lead * one.begin, period, p.limit, p.gain, p.channel[k])
        law.update(other, lead * other.begin, period, p.limit, p.gain, p.channel[k + 2])
        s.asked[k], s.asked[k + 2] = mixed(one.output, other.output, 1.0, m)


@kernel
def start(words):
    """Levitated, with what holds the static load."""
    m = words.view(MEMORY)[0]
    levitation.start(_begin_channels, m.p.clock == 1, m.p.sample_time, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    own = m.p.clock == 1
    return levitation.advance(_begin_channels, _answer_samples, own, m.p.sample_time, m, time, step)


MODEL = Model(
    name="amb_controller",
    title="Controller of magnetic bearings",
    about="Sampled PID for each axis, or for translation and tilt, with sections and re-levitation",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    starts_from={f"axis[{k + 1}].set": (f"axis[{k + 1}].hold",) for k in range(AXES)},
)
