"""Numbers and figures of a summary in words and units that people read."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

UNIT_SCALES = {  # SI unit: factors into other units, largest unit first
    "m": ((1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")),
    "s": ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")),
    "N": ((1e3, "kN"), (1.0, "N"), (1e-3, "mN")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1.0, "Pa")),
    "N/m": ((1e6, "MN/m"), (1e3, "kN/m"), (1.0, "N/m")),
    "J": ((1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ")),
    "rad": ((math.pi / 180.0, "deg"),),
    "kg": ((1.0, "kg"), (1e-3, "g")),
}
UNIT_NAMES = {"1": "", "kg.m2": "kg m²", "N.s/m": "N s/m", "N.s/m2": "N s/m²", "m/s2": "m/s²", "N.m": "N m",
          "kg/m3": "kg/m³", "N/m^n": "N/mⁿ", "N.m.s/rad": "N m s/rad", "1/(kg.m2)": "1/(kg m²)",
          "1/s2": "1/s²"}  # fmt: skip
RPM = 60.0 / (2.0 * math.pi)
NONE = "–"
ROUNDING = 1e-6  # of a unit's smallest handy size: less is a zero that was computed
ROUNDING_RATIO = 1e-12  # likewise, of the largest of some figures


def digits(value: float, count: int = 4) -> str:
    """`value` with `count` significant digits; powers of ten only where zeros would mislead."""
    if not math.isfinite(value):
        return NONE if math.isnan(value) else ("∞" if value > 0.0 else "−∞")
    text = f"{value:.{count}g}"
    if "e" in text and 1.0 <= abs(value) < 1e7:
        text = f"{float(text):,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}")
    if "e" in text:
        mantissa, _, exponent = text.partition("e")
        text = _raised(mantissa, int(exponent))
    return text.replace("-", "\N{MINUS SIGN}")


def _raised(mantissa: str, exponent: int) -> str:
    powers = str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{mantissa}·10{powers}"


def digits_of(values: Iterable[float], count: int = 3) -> tuple[str, ...]:
    """Some figures with `count` digits each; zero where one is nothing beside the largest."""
    known = [float(value) for value in values]
    least = ROUNDING_RATIO * max(map(abs, known))
    return tuple(digits(value if abs(value) > least else 0.0, count) for value in known)


def quantity(value: float | None, unit: str, count: int = 4) -> str:
    """A value in SI with a unit of a handy size; a dash where there is none."""
    if value is None:
        return NONE
    if unit in UNIT_SCALES and abs(value) < ROUNDING * UNIT_SCALES[unit][-1][0]:
        value = 0.0
    factor, name = _handy(value, unit)
    return f"{digits(value / factor, count)}\N{NO-BREAK SPACE}{name}".strip()


def _handy(value: float, unit: str) -> tuple[float, str]:
    sizes = UNIT_SCALES.get(unit)
    if sizes is None or not math.isfinite(value):
        return 1.0, UNIT_NAMES.get(unit, unit)
    fitting = (size for size in sizes if abs(value) >= 0.9999 * size[0])
    return next(fitting, sizes[-1] if value else sizes[0])


def speed(value: float | None) -> str:
    """A spin speed (rad/s) in rpm."""
    return NONE if value is None else f"{digits(RPM * value, 5)} rpm"


def percentage(value: float | None, count: int = 2) -> str:
    """A share of one in per cent."""
    return NONE if value is None else f"{digits(100.0 * value, count)} %"


def listed(words: list[str]) -> str:
    """'a', 'a and b', 'a, b and c'."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""


SEAT = re.compile(r"whirl_(?P<seat>.+?)(?P<tail>|_trend|_revolutions|_radius_um|_frequency_Hz"
                  r"|_largest_force_N|_force_phase_deg|_most_turns_one_way|_episodes)")  # fmt: skip
FIGURE_NAMES = {  # key without its component: words, and the unit of the value
    "first_contact_time_s": ("First contact, after the shutdown", "s"),
    "first_contact_speed_m_s": ("Speed of the first contact", "m/s"),
    "face_landing_time_s": ("First landing on a face", "s"),
    "face_landing_speed_m_s": ("Speed of that landing", "m/s"),
    "peak_face_force_N": ("Largest force on a face", "N"),
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
    "largest_displacement_um": ("Largest displacement from the place at the shutdown", "µm"),
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
    "capture_command_time_s": ("Asked for again, after the shutdown", "s"),
    "largest_coil_current_A": ("Largest coil current", "A"),
    "time_at_current_limit_s": ("Time at the current limit", "s"),
    "time_at_voltage_limit_s": ("Time at the voltage limit", "s"),
}
CAPTURE = re.compile(r"capture_(?P<seat>.+?)(?P<tail>|_time_s|_last_contact_s|_peak_force_N)")
CAPTURE_NAMES = {
    "": ("Captured or lost", ""),
    "_time_s": ("Captured, after the command", "s"),
    "_last_contact_s": ("Last contact, after the command", "s"),
    "_peak_force_N": ("Largest contact force after the command", "N"),
}
SEAT_FIGURE_NAMES = {
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
    """The name of a figure; `unit`: of its values as the summary has them."""

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
        words, unit = SEAT_FIGURE_NAMES[seat["tail"]]
        return Label(words, unit, seat["seat"])
    for component in ("", *components):
        base = key.removesuffix(f"_{component}") if component else key
        if base in FIGURE_NAMES and (base != key or not component):
            return Label(*FIGURE_NAMES[base], component)
    if (seat := CAPTURE.fullmatch(key)) is not None:
        return Label(*CAPTURE_NAMES[seat["tail"]], seat["seat"])
    return None
