"""Figures of a summary by the words that people read, with the units of their values."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

SEAT = re.compile(r"whirl_(?P<seat>.+?)(?P<tail>|_trend|_revolutions|_radius_um|_frequency_Hz"
                  r"|_largest_force_N|_force_phase_deg|_most_turns_one_way|_episodes)")  # fmt: skip
WORDS = {  # key without its component: words, and the unit of the value
    "first_contact_time_s": ("First contact, after the shutdown", "s"),
    "first_contact_speed_m_s": ("Speed of the first contact", "m/s"),
    "peak_contact_force_N": ("Largest contact force", "N"),
    "peak_indentation_rotor_ring_um": ("Largest indentation, journal in ring", "µm"),
    "peak_indentation_rings_um": ("Largest approach of the rings", "µm"),
    "peak_indentation_ball_inner_um": ("Largest indentation, ball in inner race", "µm"),
    "peak_indentation_ball_outer_um": ("Largest indentation, ball in outer race", "µm"),
    "peak_indentation_ball_ball_um": ("Largest indentation, ball in ball", "µm"),
    "peak_indentation_ball_cage_um": ("Largest indentation, ball in cage", "µm"),
    "peak_ball_force_N": ("Largest ball load", "N"),
    "first_impact_ball_force_N": ("Largest ball load of the first impact", "N"),
    "peak_neighbour_force_N": ("Largest force between balls", "N"),
    "peak_cage_force_N": ("Largest force on the cage", "N"),
    "ring_sync_time_s": ("Ring as fast as the rotor, after the shutdown", "s"),
    "loaded_balls_end": ("Loaded balls at the end", ""),
    "loaded_balls_mean": ("Loaded balls, mean of the last fifth", ""),
    "largest_displacement_um": ("Largest displacement in space", "µm"),
    "first_impact_contact_force_N": ("Largest contact force of the first impact", "N"),
    "first_impact_bending_stress_MPa": ("Largest bending stress of the first impact", "MPa"),
    "first_impact_shear_stress_MPa": ("Largest shear stress of the first impact", "MPa"),
    "settling_time_s": ("Settled, after the shutdown", "s"),
    "settled": ("How it ends up", ""),
    "pendulum_frequency_Hz": ("Pendulum frequency", "Hz"),
    "rotor_speed_end_rpm": ("Rotor at the end", "rpm"),
    "peak_bending_stress_MPa": ("Largest bending stress", "MPa"),
    "peak_bending_stress_node": ("Largest bending stress", "node"),
    "peak_bending_stress_time_s": ("Largest bending stress, after the shutdown", "s"),
    "peak_shear_stress_MPa": ("Largest shear stress", "MPa"),
    "peak_shear_stress_node": ("Largest shear stress", "node"),
    "peak_shear_stress_time_s": ("Largest shear stress, after the shutdown", "s"),
}
OF_SEAT = {
    "": ("Verdict", ""),
    "_trend": ("How the whirl goes on", ""),
    "_revolutions": ("Turns of the whirl", ""),
    "_radius_um": ("Radius of the whirl", "µm"),
    "_frequency_Hz": ("Frequency of the whirl", "Hz"),
    "_largest_force_N": ("Largest contact force in the whirl", "N"),
    "_force_phase_deg": ("Phase by which the force drives the whirl", "deg"),
    "_most_turns_one_way": ("Most turns of the contact one way", ""),
    "_episodes": ("Whirls, counted", ""),
}
NODE = "node"  # unit of what is a place on the rotor, of which there is no mean


@dataclass(frozen=True)
class Label:
    """What a figure is called; `unit`: of its values as the summary has them."""

    words: str
    unit: str
    of: str = ""  # the component or the seat

    @property
    def head(self) -> str:
        """Of a column: words, unit, of what."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.words}{unit}{self.place}"

    @property
    def place(self) -> str:
        """Of what, behind the words."""
        return f", {self.of}" if self.of else ""


def label(key: str, components: Iterable[str]) -> Label | None:
    """The label of a figure; None for one that has none, such as what programs alone ask for."""
    if (seat := SEAT.fullmatch(key)) is not None:
        words, unit = OF_SEAT[seat["tail"]]
        return Label(words, unit, seat["seat"])
    for component in ("", *components):
        base = key.removesuffix(f"_{component}") if component else key
        if base in WORDS and (base != key or not component):
            return Label(*WORDS[base], component)
    return None
