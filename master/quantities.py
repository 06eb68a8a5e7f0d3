"""The quantities of a run, each declared once, and the nested summary that holds them.

A summary is a dict of SI values, nested by the owner of each quantity:

    summary["completed"], summary["settling_time"]            of the run
    summary["seats"]["A"]["peak_contact_force"]               of a journal in its bearing, N
    summary["components"]["rotor"]["peak_bending_stress"]     Pa
    summary["gaps"]["seal"]["least"]                          m
    summary["requirements"]["contact_force"]["margin"]

None stands for what did not happen or cannot be told. `flat_summary` gives the same with one path for each
value, such as "seats.A.peak_contact_force", for tables. Code that shows or judges one reads its entry
here: words, unit, group, and which of several values is the worst.

A new quantity is an entry of `TABLE`. One with a `variable` is read from every bearing that has it; any
other is added by a function in `master.results`, which fails for a key that is not declared.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from typing import Any

from ..modelkit.errors import require
from ..modelkit.reader import FIGURE, Table, instance, maybe
from ..modelkit.units import per_display

Summary = dict[str, Any]


class Owner(StrEnum):
    """What a quantity is of; the key that holds its values by name in a summary."""

    RUN = ""
    SEAT = "seats"
    COMPONENT = "components"
    GAP = "gaps"
    REQUIREMENT = "requirements"


class Group(StrEnum):
    """Headings of tables, in their order."""

    DROP = "the drop"
    LANDING = "landing"
    LARGEST = "largest of the whole run"
    MOTION = "motion"
    GAPS = "gaps and strokes"
    STRENGTH = "strength and heat"
    STRESS = "stress in the rotor"
    LEVITATION = "levitation"
    REQUIREMENTS = "requirements"
    NUMERICS = "how it was computed"


class Worse(StrEnum):
    """The value that is worse of two."""

    LARGER = "larger"
    SMALLER = "smaller"
    NEITHER = ""


@dataclass(frozen=True)
class Quantity:
    """A quantity of a run.

    >>> touchdown.Quantity.of_scheme("steps_counted", "steps counted").head
    'steps counted'
    """

    key: str
    words: str
    unit: str  # SI; "1" of numbers without one, "" of text, truth values and lists
    group: Group
    owner: Owner = Owner.SEAT
    worse: Worse = Worse.LARGER
    shown_in: str = ""  # the unit in which people read it; "": `unit`
    variable: str = ""  # of a bearing, that it is read from when the run is over
    event: bool = False  # a time, of the simulation's clock where it has a `variable`; below zero: never
    bore: bool = False  # of the journal's first impact in the bore, None where it landed on a face alone
    detail: bool = False  # shown on request only: how it was computed, or what others say in words
    machine: bool = False  # differs from computer to computer
    chaotic: bool = False  # one draw of many after the first impacts: worth a spread over siblings
    timed_by: str = ""  # the key of its owner's quantity that is its time; its own, where it is a time

    @classmethod
    def of_scheme(
        cls, key: str, words: str, unit: str = "1", shown_in: str = "", worse: Worse = Worse.LARGER
    ) -> Quantity:
        """What a coupling scheme tells of how it computed a run."""
        return cls(key, words, unit, Group.NUMERICS, Owner.RUN, worse, shown_in, detail=True)

    @cached_property
    def factor(self) -> float:
        """From SI to the unit in which people read it."""
        return per_display(self.unit, self.shown_in) if self.shown_in else 1.0

    @property
    def read_in(self) -> str:
        """The unit in which people read it, "" where there is none."""
        unit = self.shown_in or self.unit
        return "" if unit == "1" else unit

    def headed(self, words: str) -> str:
        """Words, and the unit in which people read it."""
        return f"{words} [{self.read_in}]" if self.read_in else words

    @property
    def head(self) -> str:
        """Of a table: words and unit."""
        return self.headed(self.words)

    def worst(self, values: Iterable[float]) -> float | None:
        """Of some values; None of none."""
        return (min if self.worse is Worse.SMALLER else max)(values, default=None)


FIRST_IMPACT = "first_impact_"


def _peak(key: str, words: str, unit: str, variable: str, shown_in: str = "") -> tuple[Quantity, Quantity]:
    """A peak that a bearing reports, and what it was when the first impact was over."""
    peak = Quantity(f"peak_{key}", f"largest {words}", unit, Group.LARGEST, shown_in=shown_in,
                    variable=variable, chaotic=True)  # fmt: skip
    first = replace(peak, key=f"{FIRST_IMPACT}{key}", words=f"first impact: largest {words}", variable="")
    return peak, replace(first, group=Group.LANDING)


def _text(
    key: str, words: str, group: Group, owner: Owner = Owner.RUN, detail: bool = False, timed_by: str = ""
) -> Quantity:
    return Quantity(key, words, "", group, owner, Worse.NEITHER, detail=detail, timed_by=timed_by)


def _cost(key: str, words: str, unit: str = "s") -> Quantity:
    return Quantity(key, words, unit, Group.NUMERICS, Owner.RUN, detail=True, machine=True)


def _event(key: str, words: str, group: Group, owner: Owner = Owner.SEAT, detail: bool = False) -> Quantity:
    return Quantity(key, words, "s", group, owner, Worse.SMALLER, detail=detail, timed_by=key)


_PEAKS = (
    _peak("contact_force", "contact force", "N", "contact.peak_force"),
    _peak("indentation_rotor_ring", "indentation, journal in ring", "m", "contact.peak_indentation", "um"),
    _peak("indentation_rings", "approach of the rings", "m", "balls.peak_indentation", "um"),
    _peak("indentation_ball_inner", "indentation, ball in inner race", "m", "inner.peak_indentation", "um"),
    _peak("indentation_ball_outer", "indentation, ball in outer race", "m", "outer.peak_indentation", "um"),
    _peak("indentation_ball_ball", "indentation, ball in ball", "m", "neighbours.peak_indentation", "um"),
    _peak("indentation_ball_cage", "indentation, ball in cage", "m", "pockets.peak_indentation", "um"),
    _peak("neighbour_force", "force between balls", "N", "neighbours.peak_force"),
    _peak("cage_force", "force on the cage", "N", "pockets.peak_force"),
)
FIRST_IMPACTS = {first.key: peak for peak, first in _PEAKS}  # of each, the peak that it was a part of
_BALL_FORCE = Quantity(  # the bearing keeps that of the first impact apart
    "peak_ball_force", "largest ball load", "N", Group.LARGEST, variable="balls.peak_force", chaotic=True
)
HEAT_PARTS = {"journal": "the journal", "inner": "the inner ring", "balls": "the balls",
              "outer": "the outer ring"}  # fmt: skip
MOUNT_HEATS = {
    "damper": "dampers",
    "slide": "dry friction",
    "branch": "rubber",
    "stop": "the stop",
    "film": "the squeeze film",
    "spring": "cross-coupling of springs",
}
INVALID = "invalid_figures"  # paths of a summary's figures
CONTACT_TEMPERATURE = "contact_temperature"
STRESSES = "bending", "shear"
LINK_ENERGIES = {
    "mains": "energy that the mains gave",
    "generated": "energy that the rotor's motor gave",
    "taken": "energy that the actuators took",
    "standby": "energy that the electronics took",
    "burnt": "energy that the brake chopper burnt",
    "stored": "energy of the capacitor at the end",
}
PLANES = {"x": "horizontal", "y": "vertical"}


def _heats() -> Iterator[Quantity]:
    for part, words in HEAT_PARTS.items():
        yield Quantity(f"bearing_heat_{part}", f"heat in {words}", "J", Group.STRENGTH, detail=True)
    yield Quantity(
        "bearing_sliding_work",
        "sliding way times force in the bore",
        "J",
        Group.STRENGTH,
        detail=True,
    )
    for part, words in HEAT_PARTS.items():
        rise = f"temperature_rise_{part}"
        yield Quantity(rise, f"temperature rise of {words}", "K", Group.STRENGTH, detail=True)
        yield Quantity(
            f"{rise}_adiabatic", f"temperature rise of {words} without conduction", "K", Group.STRENGTH,
            detail=True,
        )  # fmt: skip


def _stresses() -> Iterator[Quantity]:
    group, component = Group.STRESS, Owner.COMPONENT
    for kind in STRESSES:
        key, words = f"peak_{kind}_stress", f"largest {kind} stress"
        time = f"{key}_time"
        yield Quantity(key, words, "Pa", group, component, shown_in="MPa", chaotic=True, timed_by=time)
        yield Quantity(f"{key}_node", f"{words}, at node", "1", group, component, Worse.NEITHER,
                       timed_by=time)  # fmt: skip
        yield _event(time, f"{words}, after the shutdown", group, component, detail=True)
    yield _event(time := "kept_stress_time", "instant of the kept stresses", group, component, detail=True)
    for kind in STRESSES:
        for axis, plane in PLANES.items():
            key, words = f"kept_{kind}_{axis}", f"largest {kind} stress of that instant, {plane} plane"
            yield Quantity(key, words, "Pa", group, component, shown_in="MPa", detail=True, timed_by=time)
            yield Quantity(f"{key}_node", f"{words}, at node", "1", group, component, Worse.NEITHER,
                           detail=True, timed_by=time)  # fmt: skip
    for kind in STRESSES:
        key, words = f"{FIRST_IMPACT}{kind}_stress", f"first impact: largest {kind} stress"
        yield Quantity(key, words, "Pa", group, component, shown_in="MPa", chaotic=True)


def _pairs() -> Iterator[Quantity]:
    """How hard rows are clamped, cold and centred."""
    for when, how in (("standing", "at rest"), ("turning", "at the speed of the shutdown")):
        key, words = f"pair_preload_{when}", f"pair's preload {how}"
        yield Quantity(key, words, "N", Group.STRENGTH, worse=Worse.NEITHER)
        key, words = f"pair_interference_{when}", f"pair's interference {how}; below 0: play"
        yield Quantity(key, words, "m", Group.STRENGTH, worse=Worse.NEITHER, shown_in="um")


TABLE: tuple[Quantity, ...] = (
    _text("scene", "scene", Group.DROP),
    _text("completed", "completed", Group.DROP),
    _text("ended", "ended", Group.DROP),
    _text("stopped_because", "stopped because", Group.DROP),
    Quantity("end_time", "end of the run, after the shutdown", "s", Group.DROP, Owner.RUN, Worse.NEITHER),
    _event("valid_until", "figures valid until, after the shutdown", Group.DROP, Owner.RUN),
    _text("invalid_because", "not valid from then on, as", Group.DROP),
    _text(INVALID, "figures of later times, counted", Group.DROP),
    Quantity("speed_end", "rotor's speed at the end", "rad/s", Group.DROP, Owner.COMPONENT, Worse.NEITHER,
             "rpm"),
    _text("bearing", "bearing", Group.DROP, Owner.SEAT),
    _text("contact_estimated_by_master", "contact estimated by the master, of", Group.DROP),
    # landing
    Quantity("first_contact_time", "first contact, after the shutdown", "s", Group.LANDING,
             worse=Worse.SMALLER, variable="contact.first_time", event=True, timed_by="first_contact_time"),
    Quantity("first_contact_speed", "speed of the first contact", "m/s", Group.LANDING,
             variable="contact.first_speed", bore=True, timed_by="first_contact_time"),
    _event("face_landing_time", "first landing on a face, after the shutdown", Group.LANDING),
    Quantity("face_landing_speed", "speed of that landing", "m/s", Group.LANDING,
             timed_by="face_landing_time"),
    Quantity("first_impact_ball_force", "first impact: largest ball load", "N", Group.LANDING,
             variable="balls.first_impact_force", bore=True, chaotic=True),
    *(first for _, first in _PEAKS),
    # largest of the whole run
    *(peak for peak, _ in _PEAKS[:-2]),
    _BALL_FORCE,
    *(peak for peak, _ in _PEAKS[-2:]),
    Quantity("peak_face_force", "largest force on a face", "N", Group.LARGEST, chaotic=True),
    Quantity("largest_journal_force", "largest force on the journal", "N", Group.LARGEST),
    Quantity("largest_journal_distance", "largest distance of the journal from the middle", "m",
             Group.LARGEST, shown_in="um"),
    Quantity("largest_displacement", "largest displacement from the place at the shutdown", "m",
             Group.LARGEST, shown_in="um", chaotic=True),
    # motion
    _text("whirl", "whirl", Group.MOTION, Owner.SEAT),
    _text("whirl_trend", "trend of the whirl", Group.MOTION, Owner.SEAT),
    Quantity("whirl_revolutions", "turns of the whirl", "1", Group.MOTION),
    Quantity("whirl_radius", "radius of the whirl", "m", Group.MOTION, shown_in="um"),
    Quantity("whirl_frequency", "frequency of the whirl", "Hz", Group.MOTION),
    Quantity("whirl_largest_force", "largest contact force in the whirl", "N", Group.MOTION),
    Quantity("whirl_force_phase", "phase by which the force drives the whirl", "rad", Group.MOTION,
             shown_in="deg"),
    Quantity("most_turns_one_way", "most turns of the contact one way", "1", Group.MOTION),
    _text("whirl_episodes", "whirls, counted", Group.MOTION, Owner.SEAT),
    Quantity("settling_time", "settling time of all seats", "s", Group.MOTION, Owner.RUN, chaotic=True,
             timed_by="settling_time"),
    Quantity("settling_time", "settling time", "s", Group.MOTION, chaotic=True, timed_by="settling_time"),
    _text("settled", "end of the motion", Group.MOTION, Owner.SEAT),
    Quantity("proposed_duration", "duration that may show it settled", "s", Group.MOTION, Owner.RUN,
             detail=True),
    Quantity("pendulum_frequency", "pendulum frequency", "Hz", Group.MOTION, worse=Worse.NEITHER),
    Quantity("ring_sync_time", "ring as fast as the rotor, after the shutdown", "s", Group.MOTION,
             variable="ring.sync_time", event=True, timed_by="ring_sync_time"),
    Quantity("loaded_balls_end", "loaded balls at the end", "1", Group.MOTION, worse=Worse.NEITHER,
             variable="balls.loaded"),
    Quantity("loaded_balls_mean", "loaded balls, mean of the last fifth", "1", Group.MOTION,
             worse=Worse.NEITHER),
    # gaps and strokes
    Quantity("least", "least gap left", "m", Group.GAPS, Owner.GAP, Worse.SMALLER, "um",
             timed_by="least_time"),
    _event("least_time", "time of the least gap, after the shutdown", Group.GAPS, Owner.GAP),
    Quantity("least_rotor_speed", "rotor's speed at the least gap", "rad/s", Group.GAPS, Owner.GAP,
             Worse.NEITHER, "rpm", timed_by="least_time"),
    Quantity("touches", "contacts in the gap", "1", Group.GAPS, Owner.GAP),
    _event("closed_time", "first contact in the gap, after the shutdown", Group.GAPS, Owner.GAP),
    Quantity("least_gap", "least gap left of all", "m", Group.GAPS, Owner.RUN, Worse.SMALLER, "um"),
    _text("least_gap_at", "place of the least gap", Group.GAPS),
    Quantity("housing_stroke", "largest stroke of the housing", "m", Group.GAPS, shown_in="um"),
    _event("stop_reached_time", "mount at its stop, after the shutdown", Group.GAPS),
    Quantity("stop_hits", "impacts on the stop", "1", Group.GAPS),
    Quantity("peak_stop_force", "largest force of the stop", "N", Group.GAPS, chaotic=True),
    *(Quantity(f"mount_heat_{key}", f"heat of the mount in {words}", "J", Group.GAPS)
      for key, words in MOUNT_HEATS.items()),
    # strength and heat
    Quantity("largest_ball_pressure", "largest pressure on a race", "Pa", Group.STRENGTH, shown_in="GPa"),
    Quantity("lowest_static_safety", "lowest static safety", "1", Group.STRENGTH, worse=Worse.SMALLER),
    Quantity("drops_until_fatigue", "drops until fatigue", "1", Group.STRENGTH, worse=Worse.SMALLER,
             detail=True),
    _text("bearing_ends_by", "what ends the bearing first", Group.STRENGTH, Owner.SEAT,
          timed_by="seized_time"),
    Quantity("bearing_heat", "heat in the bearing", "J", Group.STRENGTH),
    *_heats(),
    Quantity("largest_temperature_rise", "largest temperature rise", "K", Group.STRENGTH),
    Quantity(CONTACT_TEMPERATURE, "largest temperature rise between journal and bore", "K",
             Group.STRENGTH, variable="temperature.contact", bore=True,
             timed_by=f"{CONTACT_TEMPERATURE}_time"),
    Quantity(f"{CONTACT_TEMPERATURE}_time", "then, after the shutdown", "s", Group.STRENGTH,
             worse=Worse.SMALLER, variable="temperature.contact_time", event=True, detail=True,
             timed_by=f"{CONTACT_TEMPERATURE}_time"),
    Quantity("play_change", "change of the play by heat", "m", Group.STRENGTH, worse=Worse.NEITHER,
             shown_in="um", detail=True),
    Quantity("clearance_change", "change of the clearance by heat", "m", Group.STRENGTH,
             worse=Worse.NEITHER, shown_in="um", detail=True),
    *_pairs(),
    _event("seized_time", "ring seizes, after the shutdown", Group.STRENGTH),
    _event("ring_stop_time", "ring stands still, after the shutdown", Group.STRENGTH),
    _event("runaway_time", "heat runs away, after the shutdown", Group.STRENGTH),
    _event("play_used_up_time", "play used up, after the shutdown", Group.STRENGTH),
    _event("clearance_closed_time", "clearance closed, after the shutdown", Group.STRENGTH),
    Quantity("ball_centrifugal_share", "centrifugal force of a ball over its load, which is left out", "1",
             Group.STRENGTH),
    *_stresses(),
    # levitation
    _text("capture", "captured or lost", Group.LEVITATION, Owner.SEAT),
    Quantity("capture_time", "captured, after the command", "s", Group.LEVITATION),
    Quantity("capture_last_contact", "last contact, after the command", "s", Group.LEVITATION),
    Quantity("capture_peak_force", "largest contact force after the command", "N", Group.LEVITATION),
    _event("capture_command_time", "asked for again, after the shutdown", Group.LEVITATION, Owner.RUN),
    Quantity("largest_coil_current", "largest coil current", "A", Group.LEVITATION, Owner.RUN),
    Quantity("time_at_current_limit", "time at the current limit", "s", Group.LEVITATION, Owner.RUN),
    Quantity("time_at_voltage_limit", "time at the voltage limit", "s", Group.LEVITATION, Owner.RUN),
    Quantity("time_at_controller_limit", "time at the controller's own limit", "s", Group.LEVITATION,
             Owner.RUN),
    _text("hold_up", "without mains", Group.LEVITATION, Owner.COMPONENT),
    _event("hold_up_time", "hold-up, from the mains' failure to the first contact", Group.LEVITATION,
           Owner.COMPONENT),
    _event("lock_out_time", "DC link locks out, after the mains' failure", Group.LEVITATION,
           Owner.COMPONENT),
    *(Quantity(f"link_{key}", words, "J", Group.LEVITATION, Owner.COMPONENT, Worse.NEITHER, detail=True)
      for key, words in LINK_ENERGIES.items()),
    # requirements
    _text("requirements_met", "requirements met", Group.REQUIREMENTS),
    Quantity("margin", "margin to the requirement", "1", Group.REQUIREMENTS, Owner.REQUIREMENT,
             Worse.SMALLER, detail=True),
    # how it was computed
    _text("scheme", "coupling scheme", Group.NUMERICS, detail=True),
    _text("exchange", "exchange", Group.NUMERICS, detail=True),
    Quantity.of_scheme("macro_step", "macro step", "s", "us"),
    Quantity.of_scheme("macro_steps", "macro steps"),
    Quantity.of_scheme("macro_steps_divided_in_impacts", "macro steps divided in impacts"),
    Quantity.of_scheme("time_in_shorter_steps", "time in divided macro steps", "s"),
    Quantity.of_scheme("shortest_macro_step", "shortest macro step", "s", "us", Worse.SMALLER),
    Quantity.of_scheme("repetitions_per_step", "repetitions per macro step"),
    Quantity.of_scheme("largest_step_error", "largest error of a macro step", "m", "um"),
    Quantity.of_scheme("energy_residual_relative", "ledger's residual over the scene's energy"),
    Quantity.of_scheme("energy_residual_of_turnover", "ledger's residual over turnover"),
    _text("energy_residual_worst_connection", "ledger's worst connection", Group.NUMERICS, detail=True),
    Quantity.of_scheme("energy_made_relative", "energy error of the coupling over the scene's energy"),
    Quantity.of_scheme("energy_made_of_turnover", "energy error of the coupling over turnover"),
    Quantity.of_scheme("energy_made", "energy error of the coupling", "J"),
    Quantity.of_scheme("energy_turnover", "energy turned over", "J"),
    Quantity.of_scheme("energy_made_inside_of_turnover", "energy error inside a bearing over turnover"),
    _text("energy_made_inside_worst_bearing", "bearing with that error", Group.NUMERICS, detail=True),
    Quantity.of_scheme("energy_made_in_system_of_turnover", "energy error of the system over turnover"),
    Quantity.of_scheme("energy_balance_relative", "change of the total energy over the scene's energy"),
    Quantity.of_scheme("energy_scale", "the scene's energy", "J"),
    _text("warned", "warnings of its FMU", Group.NUMERICS, Owner.COMPONENT, detail=True),
    _text("not_audited", "not audited", Group.NUMERICS, detail=True),
    _text("not_recorded", "not recorded", Group.NUMERICS, detail=True),
    Quantity.of_scheme("simulated_time", "simulated time", "s"),
    _cost("wall_time", "wall time"),
    _cost("start_up_time", "start-up"),
    _cost("wall_time_per_simulated_second", "wall time per simulated second", "1"),
)  # fmt: skip

SPREAD = "spread"  # of a summary: of chaotic quantities over drops that start nanometres apart

_declared: dict[tuple[Owner, str], Quantity] = {}


def declare_quantities(*more: Quantity) -> None:
    """Add to the table, such as what a coupling scheme of your own tells. The same one twice is fine.

    Raises TouchdownError where the table has another one of that key.
    """
    for one in more:
        known = _declared.setdefault((one.owner, one.key), one)
        require(known == one, f"another quantity is called {one.key} already; give this one another key")


declare_quantities(*TABLE)


def quantities() -> list[Quantity]:
    """All that are declared, by groups."""
    order = list(Group)
    return sorted(_declared.values(), key=lambda one: order.index(one.group))


def named(key: str) -> list[Quantity]:
    """Those with this key: one, or one of the run and one of its seats; none where it is not declared."""
    return [one for one in _declared.values() if one.key == key]


@dataclass(frozen=True)
class Item:
    """A quantity of a particular seat, component, gap or requirement; `name` is "" for the run."""

    quantity: Quantity
    name: str = ""

    @property
    def path(self) -> str:
        """Its place in a summary as one text, for columns of tables."""
        return ".".join(filter(None, (self.quantity.owner.value, self.name, self.quantity.key)))

    @property
    def words(self) -> str:
        """Words, and of what."""
        return f"{self.quantity.words}, {self.name}" if self.name else self.quantity.words

    @property
    def head(self) -> str:
        """Of a column for people: words, of what, and the unit."""
        return self.quantity.headed(self.words)

    def of(self, summary: Mapping[str, Any]) -> Any:
        """Its value in a summary; None where it has none."""
        return owned(summary, self.quantity.owner).get(self.name, {}).get(self.quantity.key)


def owned(summary: Mapping[str, Any], owner: Owner) -> Mapping[str, Mapping[str, Any]]:
    """The values of an owner's quantities by name; the run's under ""."""
    return {"": summary} if owner is Owner.RUN else summary.get(owner, {})


def summary_items(*summaries: Mapping[str, Any]) -> list[Item]:
    """All that any of the summaries has a value or None for, in the order of groups."""
    keys: dict[tuple[Owner, str], set[str]] = {}
    for summary in summaries:
        for owner in Owner:
            for name, values in owned(summary, owner).items():
                keys.setdefault((owner, name), set()).update(values)
    return [
        Item(quantity, name)
        for quantity in quantities()
        for (owner, name), known in keys.items()
        if owner is quantity.owner and quantity.key in known
    ]


def enter(summary: Summary, values: Mapping[str, object], owner: Owner = Owner.RUN, name: str = "") -> None:
    """Put values of declared quantities into a summary, as JSON has them: no enumerations, nan or inf."""
    place = summary if owner is Owner.RUN else summary.setdefault(owner.value, {}).setdefault(name, {})
    for key, value in values.items():
        assert (owner, key) in _declared, f"declare {key} of {owner or 'the run'} in master/quantities.py"
        if isinstance(value, float) and not math.isfinite(value):
            value = None
        place[key] = str(value) if isinstance(value, StrEnum) else value


class _Kept(dict[str, Any]):
    """Quantities that a file has; what it lacks did not happen."""

    def __missing__(self, key: str) -> None:
        return None


_WORDS = maybe(instance((str, bool, list), "text, a truth value or a list"))


def checked(values: Mapping[str, Any], where: str) -> Summary:
    """The summary that a file, `where`, has. Raises TouchdownError where a value is not of its kind."""
    top = Table(f"{where}: ", values)
    found = _Kept(values)
    for owner in Owner:
        tables = {"": top}
        if owner is not Owner.RUN:
            inner = top.table(owner)
            tables = {name: inner.table(name) for name in inner.values}
            if owner in values:
                found[owner] = {name: _Kept(table.values) for name, table in tables.items()}
        for table in tables.values():
            for key in table.values:
                if one := _declared.get((owner, key)):
                    table.get(key, maybe(FIGURE) if one.unit else _WORDS)
    if SPREAD in values:
        spread = top.table(SPREAD)
        over = spread.table("quantities")
        figures = [(spread, "siblings"), (spread, "apart")]
        figures += [(over.table(name), key) for name in over.values for key in ("least", "median", "most")]
        for table, key in figures:
            table.get(key, FIGURE)
    return found


def values_of(summary: Mapping[str, Any], key: str, owner: Owner = Owner.SEAT) -> dict[str, Any]:
    """The values of a quantity by seat, or by what else has it; without those that lack it."""
    return {name: values[key] for name, values in owned(summary, owner).items() if key in values}


def finite_number(value: object) -> float | None:
    """A value of a summary where it is a number."""
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def worst(summary: Mapping[str, Any], quantity: Quantity) -> float | None:
    """The worst value of a quantity over all that have it; None where one is not known.

    None at a bearing that was not touched does not count, but for its housing's stroke, which others make.
    """
    values = values_of(summary, quantity.key, quantity.owner)
    if quantity.owner is Owner.SEAT and quantity.group is not Group.GAPS:
        values = {n: v for n, v in values.items() if v is not None or was_touched(summary["seats"][n])}
    known = [finite_number(value) for value in values.values()]
    return quantity.worst(value for value in known if value is not None) if None not in known else None


def most(summary: Mapping[str, Any], key: str) -> float | None:
    """The worst of the known values under `key`: the run's, or over all seats; None where none is known."""
    for quantity in sorted(named(key), key=lambda one: one.owner is not Owner.RUN):
        known = [finite_number(value) for value in values_of(summary, key, quantity.owner).values()]
        if known:
            return quantity.worst(v for v in known if v is not None and math.isfinite(v))
    return None


CONTACTS = "first_contact_time", "face_landing_time"  # in the bore, on a face


def was_touched(seat: Mapping[str, Any]) -> bool:
    """Whether a seat's bearing was, in its bore or on a face."""
    return any(seat.get(key) is not None for key in CONTACTS)


def first_touch(summary: Mapping[str, Any]) -> float | None:
    """The first contact anywhere, of a journal or a shoulder (s from the zero); None: nothing touched."""
    times = (values_of(summary, key).values() for key in CONTACTS)
    return min((time for found in times for time in found if time is not None), default=None)
