"""What all rolling bearings declare alike: parameters, outputs, memory."""

from __future__ import annotations

from dataclasses import dataclass

from bearings import ring, seat
from bearings.balls import BallReport, BallSet, RaceStiffness
from bearings.contact import ContactLaw
from bearings.friction import FrictionLaw
from bearings.journal_contact import ContactMemory, ContactReport
from modelkit.ports import Energy, Interface, MountReaction, SeatReaction
from modelkit.variables import group, real


@dataclass(frozen=True)
class RollingParameters:
    """The journal in its bore, the balls, the inner ring."""

    clearance: float = real(0.3e-3, "m", "radial clearance of the journal in the bore", above=0.0)
    journal_radius: float = real(9.7e-3, "m", "radius of the journal", above=0.0)
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    interface: Interface = group(Interface)
    contact: ContactLaw = group(ContactLaw, damping=1e7)
    friction: FrictionLaw = group(FrictionLaw)
    balls: BallSet = group(BallSet)
    ring: ring.Ring = group(ring.Ring)


@dataclass(frozen=True)
class RollingOutputs:
    """Loads, and what to know of the inside."""

    journal: SeatReaction = group(SeatReaction)
    housing: MountReaction = group(MountReaction)
    contact: ContactReport = group(ContactReport)
    ring: ring.RingReport = group(ring.RingReport)
    balls: BallReport = group(BallReport)
    energy: Energy = group(Energy)
    stiffness: RaceStiffness = group(RaceStiffness)


@dataclass(frozen=True)
class RollingDerived:
    """What parameters fix."""

    friction: FrictionLaw = group(FrictionLaw)
    race: ContactLaw = group(ContactLaw)
    inner: float = real(0.0, "N/m^n", "ball on inner race")
    outer: float = real(0.0, "N/m^n", "ball on outer race")
    inner_radius: float = real(0.0, "m", "inner race")
    rest_x: float = real(0.0, "m", "where the ring rests on the balls, from the middle")
    rest_y: float = real(0.0, "m", "where the ring rests on the balls, from the middle")


@dataclass(frozen=True)
class RollingMemory:
    """Memory between evaluations and steps."""

    seat: seat.SeatMemory = group(seat.SeatMemory)
    ring: ring.RingMemory = group(ring.RingMemory)
    contact: ContactMemory = group(ContactMemory)
