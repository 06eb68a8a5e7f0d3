"""The unbalance, on whose phase it hangs how a rotor lands and whether it whirls."""

from __future__ import annotations

from touchdown.master.results.ending import Readable

ANGLE = "unbalance_angle"  # of a rotor at the start
SIZES = ("eccentricity", "unbalance_scale")  # without it there is no unbalance, where a rotor states one


def unbalanced(system: Readable) -> list[str]:
    """The bodies with an unbalance that can be turned, in the order of the scene."""
    return [
        name
        for name in dict.fromkeys(a.body for a in system.attachments)
        if f"{name}.{ANGLE}" in system
        and all(system.value(f"{name}.{size}") != 0.0 for size in SIZES if f"{name}.{size}" in system)
    ]
