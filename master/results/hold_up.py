"""How long a rotor levitates on a DC link once the mains have failed, and on which energies.

Hold-up is the time from the last failure of a link's mains to the first contact of the rotor anywhere. A
rotor that has not dropped to the end of the run has none, nor one that had touched before; words say so.
"""

from __future__ import annotations

from ..quantities import LINK_ENERGIES, Owner, Summary, enter, first_touch
from .final_state import ReadableSystem

FAILED, BACK, LOCKED = "failed_time", "back_time", "locked_time"  # s, of a link; below zero: never


def links(system: ReadableSystem) -> list[str]:
    """The components that are DC links with mains."""
    return [name for name in system.components if f"{name}.{LOCKED}" in system]


def add_hold_ups(summary: Summary, system: ReadableSystem, zero: float) -> None:
    """Of every link. zero, s: the scene's, on the simulation's clock; summary: with what touched when."""
    touched = first_touch(summary)
    for name in links(system):
        failed, back, locked = (system.value(f"{name}.{time}") for time in (FAILED, BACK, LOCKED))
        held = None if touched is None else touched + zero - failed
        if failed < 0.0:
            words, held = "the mains did not fail", None
        elif back >= 0.0 and (held is None or held > back - failed):
            words, held = f"levitated until the mains were back, {back - failed:.3g} s", None
        elif held is None:
            words = f"levitated to the end of the run, {summary['end_time'] + zero - failed:.3g} s"
        elif held < 0.0:
            words, held = "had touched before the mains failed", None
        else:
            words = "dropped" if locked >= failed and locked - failed <= held else "dropped, the link alive"
        values = {"hold_up": words, "hold_up_time": held}
        values["lock_out_time"] = locked - failed if locked >= failed >= 0.0 else None
        for key in LINK_ENERGIES:
            values[f"link_{key}"] = system.value(f"{name}.energy.{key}")
        enter(summary, values, Owner.COMPONENT, name)
