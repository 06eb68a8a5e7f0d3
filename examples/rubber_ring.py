"""A touchdown bearing of your own in C: a rubber ring with a clearance. Its code is in rubber_ring.c."""

from dataclasses import dataclass
from pathlib import Path

from touchdown.fmus.native.in_c import in_c
from touchdown.modelkit.ports import MountLoad, PointMotion, SeatLoad, SeatMotion
from touchdown.modelkit.variables import group, real


@dataclass(frozen=True)
class Parameters:
    clearance: float = real(0.2e-3, "m", "radial clearance", above=0.0)
    stiffness: float = real(2e6, "N/m", "of the rubber", minimum=0.0)
    damping: float = real(500.0, "N.s/m", "of the rubber", minimum=0.0)


@dataclass(frozen=True)
class Inputs:
    journal: SeatMotion = group(SeatMotion)
    housing: PointMotion = group(PointMotion)


@dataclass(frozen=True)
class Outputs:
    journal: SeatLoad = group(SeatLoad)
    housing: MountLoad = group(MountLoad)
    peak_force: float = real(0.0, "N", "largest force so far", local=True)


MODEL = in_c(
    name="rubber_ring",
    title="Rubber ring",
    about="A rubber ring with a clearance around the journal, without friction",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    source=Path(__file__).with_name("rubber_ring.c"),
    problems=("clearance = {0:g} m is no touchdown bearing's; take less than 10 mm",),
)
