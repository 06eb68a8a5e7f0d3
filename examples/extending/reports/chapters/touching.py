"""How long the rotor touches."""

from __future__ import annotations

import numpy as np

from ..layout import Absent, Data
from ..numbers import percentage
from ..subject import Subject


def touching(subject: Subject) -> Data:
    """The part of the recorded moments with a contact. Raises Absent without one."""
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    parts = [(a, float(np.mean(subject.values(a, "contact.force") > 0.0))) for a in subject.seats]
    return {
        "rows": [[subject.name(a), percentage(part)] for a, part in parts],
        "flies": all(part < 0.5 for _, part in parts),
    }
