"""The account of the energy that crossed one connection."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..bonds.exchange import BondExchange
from ..connections import Attachment
from ..loop.kernels.port_accounts import BOOK, FORCE_PER_ENERGY, LASTING_CONTACT_SHARE

MIN_WORKING_STEPS = 4  # steps in which a bond has done work, before it is judged


class WorkAccount:
    """One connection's: a name for what stands in its record, which kernels book in."""

    def __init__(self, title: str, record: Any = None) -> None:
        """`record`: a row of an array of BOOK; a blank one where none is given."""
        self.title = title  # of the connection, for people
        self.record = np.zeros(1, BOOK)[0] if record is None else record
        self.unaudited = ""  # why, where it is not audited

    @property
    def total(self) -> float:
        """Sum of |r_n| (J)."""
        return float(self.record["total"])

    @property
    def made(self) -> float:
        """Minus the sum of r_n (J)."""
        return float(self.record["made"])

    @property
    def turned(self) -> float:
        """Sum of |mean force times displacement| (J)."""
        return float(self.record["turned"])

    @property
    def turnover(self) -> float:
        """Energy that the motion turned over at the port, its kinetic energy with it (J)."""
        return float(self.record["turned"] + self.record["kinetic"])

    def book(self, residual: float) -> None:
        """Add a macro step's (J)."""
        self.record["total"] += abs(residual)
        self.record["wrong"] += abs(residual)
        self.record["made"] -= residual


class SeatAccount(WorkAccount):
    """Of a bearing's port on a body's port."""

    def __init__(self, attachment: Attachment, record: Any = None) -> None:
        super().__init__(attachment.title, record)
        self.attachment = attachment


class BondAccount(WorkAccount):
    """Of a bond, whose crossing hears what is made.

    It tells no mass, so how much energy the motion brings along is not known; it is judged once it has
    turned some over.
    """

    def __init__(self, crossing: BondExchange, record: Any = None) -> None:
        super().__init__(crossing.bond.title, record)
        self.crossing = crossing

    @property
    def total(self) -> float:
        return self.crossing.past.audit.total

    @property
    def made(self) -> float:
        return self.crossing.past.audit.made

    @property
    def turned(self) -> float:
        return self.crossing.past.audit.turned

    @property
    def turnover(self) -> float:
        return self.turned

    def fetch(self) -> None:
        """Take over, for judgement, what was estimated so far."""
        estimate = self.crossing.past.audit
        if estimate.loaded >= MIN_WORKING_STEPS:
            self.record["total"], self.record["turned"] = (
                estimate.error_share * estimate.turned,
                estimate.turned,
            )
            self.record["wrong"] = (
                estimate.error_share * LASTING_CONTACT_SHARE / FORCE_PER_ENERGY * estimate.turned
            )  # to be that share again
