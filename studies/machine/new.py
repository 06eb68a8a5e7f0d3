"""A new machine: a folder with a scene to start from."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...bearings import catalogue
from ...bearings.catalogue import BALL_MATERIALS, OWN_FILE, Bearing
from ...master.common.errors import TouchdownError, one_of
from ...master.common.files import keep_other, writing_to
from ...master.common.text import joined
from ...master.scene.file import SCENE_FILE
from ...master.scene.plausible import MIN_BORE_FILL
from ...modelkit.kernel.writing import child_path, make_folder
from ...modelkit.kernel.writing import write as write_file
from ...modelkit.reader import text_of
from ...rotor.beams.shaft import Shaft, Station
from ...rotor.file import parse_rotor, rotor_text, shipped_rotors
from ..rotor.rotor_report import find_rotor
from .bearings import find_bearing
from .machine_design import GRAVITY, Design, Support, first_bending, kept_modes, sensible_speed, supports
from .mount_rules import chosen_mount
from .scene_text import scene_text

LEVITATED_LINE = re.compile(r"^levitated_at\s*=\s*\[[^\]]*\]", re.MULTILINE)
TABLE_HEAD = re.compile(r"^\[", re.MULTILINE)
STATIONS_HEAD = re.compile(r"^\[stations\][^\n]*\n", re.MULTILINE)


def _with_places(shaft: Shaft, seats: Sequence[str], magnets: Sequence[str]) -> tuple[Shaft, list[str]]:
    """A rotor that its magnetic bearings hold at the start, and their stations.

    A magnetic bearing at a touchdown bearing's station gets one of its own at the same node. Raises
    TouchdownError where the name of that is taken.
    """
    stations, held = list(shaft.stations), list[str]()
    for name in magnets:
        if name not in seats:
            held.append(name)
            continue
        there = next((s.node for s in stations if s.name == name), None)
        station_name = f"amb_{name}"
        taken = next((s.node for s in stations if s.name == station_name), there)
        if taken != there:
            raise TouchdownError(
                f"--amb {name}: {shaft.title} has a station {station_name} elsewhere; name that"
            )
        if there is not None and all(s.name != station_name for s in stations):
            stations.append(Station(station_name, there))
        held.append(station_name)
    return replace(shaft, stations=tuple(stations), levitated_at=tuple(held)), held


def _rewritten(text: str, shaft: Shaft, target: Shaft) -> str:
    """The text of `shaft`'s file, changed to that of `target`: its stations and who levitates it.

    Comments and layout stay where that is possible. Raises TouchdownError where it cannot be written.
    """
    if target == shaft:
        return text
    names = ", ".join(f'"{name}"' for name in target.levitated_at)
    line = f"levitated_at = [{names}]"
    changed, found = LEVITATED_LINE.subn(line, text, count=1)
    if not found:
        first = TABLE_HEAD.search(text)
        position = first.start() if first else len(text)
        changed = f"{text[:position]}{line}  # who holds the rotor at the start\n\n{text[position:]}"
    added = [s for s in target.stations if s not in shaft.stations]
    lines = "".join(f"{s.name} = {s.node}\n" for s in added)
    if added:
        changed = STATIONS_HEAD.sub(lambda match: match[0] + lines, changed, count=1)
    try:
        parsed = parse_rotor(changed, "the rotor")
        in_order = replace(parsed, stations=target.stations)  # stations may stand in another one
        if set(parsed.stations) == set(target.stations) and in_order == target:
            return changed
    except TouchdownError:
        pass
    return rotor_text(target, "the rotor with the places of its magnetic bearings")


ROTOR_FILE = "rotor.toml"
UNITS = {"speed": "rad/s", "clearance": "m", "mass": "kg", "inertia": "kg.m2"}  # of what may be given
CLEARANCE = 0.25e-3  # m; half an air gap of 0.5 mm
ROUNDING = 1e-9  # m, of a journal that is to have its clearance


@dataclass(frozen=True)
class Wanted:
    """A request for a machine; numbers in SI, None where a rule decides."""

    bearings: Sequence[str]  # one for all, or one for each place, which STATION=NAME tells
    rotor: str | None = None  # a name, or the path of a rotor's .toml
    at: Sequence[str] | None = None  # stations of the touchdown bearings; None: those of STATION=NAME
    amb: Sequence[str] | None = None  # and of the magnetic ones
    speed: float | None = None  # rad/s
    clearance: float = CLEARANCE
    mass: float | None = None  # of a rigid rotor
    inertia: float | None = None  # and its polar moment of inertia
    balls: str | None = None  # material of the bearings' balls; None: as they are designated
    mount: str | None = (
        None  # what they sit in: soft, stiff, or the path of a mount's .toml; None: housings
    )
    axial: str | None = None  # station of the touchdown bearing with faces; None: that of the first pair
    inclination: float = 0.0  # rad, of the +z end over the horizontal
    controller: bool = False  # magnetic bearings have magnets and a controller


@dataclass(frozen=True)
class _Machine:
    """The files of a machine: their texts by name, and what the user is to know."""

    files: Mapping[str, str]
    notes: Sequence[str] = field(default_factory=list)


def machine(request: Wanted, title: str) -> _Machine:
    """The files of the machine asked for. Raises TouchdownError for what cannot be."""
    for name, unit in UNITS.items():
        value = getattr(request, name)
        if value is not None and not 0.0 < value < math.inf:
            raise TouchdownError(f"{name} = {value:g} {unit} must be above 0")
    if not abs(request.inclination) <= 0.5 * math.pi:
        degrees = math.degrees(request.inclination)
        raise TouchdownError(f"inclination = {degrees:g} deg must lie between -90 and 90 deg")
    places = _Bearings(request.bearings, request.balls)
    if request.rotor is not None:
        if request.mass is not None or request.inertia is not None:
            raise TouchdownError("--mass and --inertia are of a rigid rotor; leave them out, or --rotor")
        shaft = find_rotor(os.fspath(request.rotor))
        design, files = _flexible(request, shaft, places)
        notes = [*design.notes(), *_of_rotor(shaft, design)]
    else:
        if request.at or request.amb:
            raise TouchdownError("--at and --amb are stations of a rotor's file; give --rotor, too")
        if request.mass is None:
            raise TouchdownError('--rotor FILE.toml, or --mass such as "60 kg" of a rigid one, is missing')
        shaft, files = None, places.files
        design = _rigid(request, request.mass, title, places)
        notes = design.notes()
    if request.controller:
        from .levitated import levitated  # the loops, which other machines do without

        design, more = levitated(design, files, shaft)
        notes += more
    return _Machine(files | {SCENE_FILE: scene_text(design)}, notes)


def write(built: _Machine, folder: Path, force: bool) -> Path:
    """Write a machine's files into `folder`; returns the scene's path.

    Raises TouchdownError where one of them is there and `force` does not say to replace it.
    """
    if folder.exists() and not folder.is_dir():
        raise TouchdownError(f"{folder} is a file; choose another name for the machine's folder")
    for name, text in built.files.items():
        if not force:
            keep_other(child_path(folder, name), text, "folder")
    with writing_to(folder):
        make_folder(folder)
        for name, text in built.files.items():
            write_file(child_path(folder, name), text)
    return folder / SCENE_FILE


class _Bearings:
    """The touchdown bearings asked for, and the user's file that goes along with the scene."""

    def __init__(self, names: Sequence[str], balls: str | None) -> None:
        if not names:
            raise TouchdownError("--bearings is missing; `touchdown catalogue` lists what there is")
        self.files: dict[str, str] = {}
        parted = [name.partition("=") for name in names]
        self.stations = [station.strip() for station, equals, _ in parted if equals]
        if self.stations and len(self.stations) < len(names):
            raise TouchdownError(f"--bearings {', '.join(names)}: give all as STATION=NAME, or none")
        names = [name.strip() for _, _, name in parted] if self.stations else names
        if balls is not None and balls not in BALL_MATERIALS:
            raise TouchdownError(f"balls = {balls}: {one_of(balls, BALL_MATERIALS)}")
        found = [(self._preset(name), find_bearing(name, Path())) for name in names]
        self._found: list[tuple[str, Bearing]] = [
            (name, bearing if balls is None else bearing.with_balls(BALL_MATERIALS.index(balls)))
            for name, bearing in found
        ]

    def of(self, places: Sequence[Support]) -> tuple[tuple[str, ...], tuple[Bearing, ...]]:
        """The bearings for each place, and their names in the scene. Raises TouchdownError."""
        if self.stations:
            there = [place.station for place in places]
            if sorted(there) != sorted(self.stations):
                raise TouchdownError(
                    f"--bearings are at {joined(self.stations)}, and the rotor is held at {joined(there)}; "
                    "name each once"
                )
            found = [self._found[self.stations.index(station)] for station in there]
            return tuple(name for name, _ in found), tuple(bearing for _, bearing in found)
        if len(self._found) not in (1, len(places)):
            raise TouchdownError(
                f"--bearings names {len(self._found)} bearings for {len(places)} places; "
                "give one for all, or one for each"
            )
        found = self._found * len(places) if len(self._found) == 1 else self._found
        return tuple(name for name, _ in found), tuple(bearing for _, bearing in found)

    def _preset(self, name: str) -> str:
        """The bearing's name in the scene; a user's file is copied along."""
        try:
            found = catalogue.bearing_reference(name, Path())
        except TouchdownError:
            return name  # `find_bearing` says why
        file, colon, inside = found.rpartition(":")
        if not colon:
            return name
        text = text_of(Path(file))
        if self.files.setdefault(OWN_FILE, text) != text:
            raise TouchdownError(
                f"--bearings: bearings of two files cannot both become {OWN_FILE}; join them"
            )
        return inside


def _flexible(request: Wanted, shaft: Shaft, bearings: _Bearings) -> tuple[Design, dict[str, str]]:
    """A machine with a rotor's file, which goes along with the places of its bearings in it."""
    source = os.fspath(request.rotor or "")
    seats = request.at or bearings.stations or None
    if seats is None:  # those without a magnetic bearing, where that leaves two
        free = [s.name for s in shaft.seats if s.name not in (request.amb or ())]
        seats = free if len(free) > 1 else [s.name for s in shaft.seats]
    magnets = request.amb if request.amb is not None else shaft.levitated_at
    touchdown = supports(shaft, "bearing", seats, "--at")
    supports(shaft, "amb", magnets, "--amb")
    placed, held = _with_places(shaft, seats, magnets)
    path = Path(source) if source.endswith(".toml") else shipped_rotors()[source]
    bending = first_bending(shaft)
    shared = _shared(request, touchdown, bearings, bending)
    design = Design(
        rotor=ROTOR_FILE,
        title=shaft.title,
        mass=shaft.mass,
        inertia=None,
        modes=kept_modes(placed, touchdown, shared["bearings"], shared["clearance"]),
        magnetic=supports(placed, "amb", held, "--amb"),
        **shared,
    )
    return design, bearings.files | {ROTOR_FILE: _rewritten(text_of(path), shaft, placed)}


def _rigid(request: Wanted, mass: float, title: str, bearings: _Bearings) -> Design:
    """A machine with a rigid rotor on one touchdown bearing, in the plane of its middle."""
    weight = mass * GRAVITY
    shared = _shared(request, (Support("bearing", "A", weight),), bearings, None)
    radius = 0.5 * shared["bearings"][0].bore - shared["clearance"]
    return Design(
        rotor="rigid_rotor",
        title=title,
        mass=mass,
        inertia=mass * radius**2 if request.inertia is None else request.inertia,
        modes=None,
        magnetic=(Support("amb", "amb", weight),),
        **shared,
    )


def _shared(
    request: Wanted, touchdown: tuple[Support, ...], bearings: _Bearings, bending: float | None
) -> dict[str, Any]:
    """What designs of flexible and rigid rotors have alike; bending: the first frequency (Hz)."""
    presets, kinds = bearings.of(touchdown)
    return {
        "bending": bending,
        "speed": sensible_speed(bending, kinds) if request.speed is None else request.speed,
        "clearance": _checked_clearance(request.clearance, kinds),
        "touchdown": touchdown,
        "bearings": kinds,
        "presets": presets,
        "mount": chosen_mount(request.mount),
        "axial": _with_faces(request, touchdown, kinds),
        "inclination": request.inclination,
    }


def _with_faces(request: Wanted, places: Sequence[Support], bearings: Sequence[Bearing]) -> str:
    """The component that stops the rotor along its shaft; "" where it keeps its place.

    Raises TouchdownError where there is none at the station asked for, or nothing holds the rotor's weight.
    """
    kinds = {place.station: one for place, one in zip(places, bearings, strict=True)}
    pairs = [station for station, one in kinds.items() if one.angle_in_drops > 0.0]
    station = request.axial or next(iter(pairs), "")
    if not station and not request.inclination:
        return ""
    if station not in kinds:
        raise TouchdownError(
            f"--axial {station}: no touchdown bearing is there; {one_of(station, kinds)}"
            if station
            else "--inclination: nothing stops the rotor along its shaft; name a station by --axial, or "
            'take a pair such as "7014 AC DB"'
        )
    if kinds[station].contact_angle > 0.0 and station not in pairs:
        name = kinds[station].designation
        raise TouchdownError(
            f"--axial {station}: {name} is a single row of angular contact; take a pair, {name} DB, or a "
            "deep groove bearing"
        )
    return next(place.component for place in places if place.station == station)


def _checked_clearance(clearance: float, bearings: Sequence[Bearing]) -> float:
    """The clearance (m), which leaves a journal in each bore. Raises TouchdownError."""
    for bearing in bearings:
        if not 0.0 < clearance < 0.25 * bearing.bore:
            raise TouchdownError(
                f"--clearance of {1e3 * clearance:g} mm leaves no journal in the bore of "
                f"{bearing.designation}, {1e3 * bearing.bore:g} mm; give a radial one such as 0.25 mm"
            )
    return clearance


def _of_rotor(shaft: Shaft, design: Design) -> list[str]:
    """Notes on points to check in the rotor's file: journals without their clearance, no unbalance.

    Raises TouchdownError where a bearing does not go onto the shaft.
    """
    notes = list[str]()
    for support, bearing in zip(design.touchdown, design.bearings, strict=True):
        node = shaft.node(support.station)
        around = shaft.elements[max(node - 2, 0) : node]
        widths = [element.widest for element in around] or [0.0]  # a superelement's are not known
        thickest, thinnest = max(widths), min(widths)
        room = bearing.bore - 2.0 * design.clearance
        if thinnest > bearing.bore + ROUNDING:
            raise TouchdownError(
                f"{bearing.designation} cannot be mounted at {support.station}: its bore is "
                f"{1e3 * bearing.bore:g} mm, the rotor {1e3 * thinnest:g} mm thick there; choose a wider "
                "one (`touchdown catalogue`), or turn the shaft down in the rotor's file"
            )
        if thickest > room + ROUNDING:
            notes.append(
                f"the rotor is {1e3 * thickest:g} mm thick at {support.station}, more than the bore of "
                f"{bearing.designation} less the clearance, {1e3 * room:g} mm; its journal is taken to fit"
            )
        elif 0.0 < thickest < MIN_BORE_FILL * room:
            notes.append(
                f"the rotor is {1e3 * thickest:g} mm thick at {support.station}, and the bore of "
                f"{bearing.designation} {1e3 * bearing.bore:g} mm wide; a sleeve is taken to fill the rest"
            )
    if not any(unbalance.moment for unbalance in shaft.unbalances):
        notes.append(f"the rotor has no unbalance; add [[unbalance]] to its file {ROTOR_FILE}")
    return notes
