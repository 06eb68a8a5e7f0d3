"""A scene's rotor described, and rotors of other programs imported."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.files import make_writable
from ...master.common.text import percent
from ...master.scene.scene import Scene
from ...rotor.beams.shaft import Shaft, Support
from ...rotor.file import load_rotor, rotor_text
from ...rotor.imports import from_ross, of_arrays, placed, read_rotor
from ...rotor.imports.formats import Places
from ...rotor.modal.modes import fullest
from ...rotor.modal.supported import static_stiffness
from ...rotor.modal.whirl_speeds import CriticalMap, critical_map
from ...rotor.properties import RotorProperties
from .rig import Answer
from .rotor_in_bearings import held_lines
from .rotor_report import MODES, SPEED, Report, described, report_text
from .supports import Bearing, RotorModel, SupportCondition, rotor_model, support_conditions


def import_rotor(
    source: Any,
    at: Places | None = None,
    amb: Places | None = None,
    sensors: Places | None = None,
    speed: float | None = None,
) -> Shaft:
    """The rotor in a file or folder (`rotor.imports.read`), of arrays by name, or of a `ross.Rotor`.

    at: stations for touchdown bearings; amb: those that levitate it before it drops; sensors: where only
    motion is asked for. Each is a node (from 1), or text such as "120 mm" from node 1, by name. speed:
    rad/s, at which bearings whose coefficients depend on it are taken. Raises TouchdownError.
    """
    try:
        shaft = placed(_read_shaft(source, speed), at, amb, sensors)
        rotor_text(shaft, f"rotor {shaft.title}")  # what no rotor file can say is named here
    except TouchdownError as error:
        raise TouchdownError(_already(source) or str(error)) from None
    return shaft


def _already(source: Any) -> str:
    """A note that a file is one of the project's own rotors; "" for others."""
    if not isinstance(source, (str, os.PathLike)) or not os.fspath(source).endswith(".toml"):
        return ""
    try:
        load_rotor(os.fspath(source))
    except TouchdownError:
        return ""
    return (
        f"{os.fspath(source)} is a rotor's file already; `touchdown rotor` describes it, `touchdown new "
        "FOLDER --rotor` makes a machine with it"
    )


def _read_shaft(source: Any, speed: float | None) -> Shaft:
    """The rotor as stated, without places. Raises TouchdownError."""
    if isinstance(source, (str, os.PathLike)):
        return read_rotor(os.fspath(source), speed)
    if isinstance(source, Mapping):
        return of_arrays(source, "the arrays", "Rotor of matrices")
    return from_ross(source, speed)


MISFIT_LIMIT = 1e-2  # of a law; above, it is said
ISOTROPY_TOLERANCE = 1e-6  # directions of a support that differ by less are the same
SPEEDS = 41  # speeds of a Campbell diagram
MAX_SPEED_RATIO = 2.0  # times the speed asked for: its end


@dataclass(frozen=True)
class SceneRotor:
    """All that is known of a scene's rotor before it is dropped."""

    scene: Scene
    properties: RotorProperties  # free; its maps of critical speeds mark what the situations' bearings have
    support_conditions: tuple[SupportCondition, ...]
    unheld: tuple[str, ...]  # a line for each situation that there is not
    remarks: tuple[str, ...]  # what a run of the scene would say before its first step


def described_in(
    scene: Scene, speed: float | None = None, modes: int = MODES, load: float = 1.0
) -> SceneRotor:
    """The rotor of `scene` at `speed` (rad/s, signed; None: the scene's own), free and on what holds it.

    modes: told of the free rotor, per plane; load: of the touchdown bearings, over what they carry of its
    weight. Raises TouchdownError where the scene has no rotor of elements, or nothing that holds it.
    """
    model = rotor_model(scene)
    model = model if speed is None else replace(model, speed=speed)
    asked = abs(model.speed)
    end = MAX_SPEED_RATIO * (asked or SPEED)
    found, unheld = support_conditions(model, [asked, *np.linspace(0.0, end, SPEEDS)], load)
    free = described(replace(model.shaft, supports=()), asked, modes)
    maps = [one for situation in found if (one := _map(model, situation)) is not None]
    free = replace(free, critical=tuple(maps))
    return SceneRotor(scene, free, tuple(found), tuple(unheld), model.remarks)


def report_scene(scene: Scene, folder: Path, speed: float | None, modes: int, load: float) -> Report:
    """`described_in` as text and as pictures in `folder`."""
    found = described_in(scene, speed, modes, load)
    make_writable(folder)
    from .figure import draw_pictures  # matplotlib is slow to import

    held = {one.name: (one.held, title_of(found, one)) for one in found.support_conditions}
    pictures = draw_pictures(found.properties, folder, held)
    return Report(scene_text(found), pictures, found.remarks)


def title_of(found: SceneRotor, situation: SupportCondition) -> str:
    """Of a situation's Campbell diagram."""
    return f"{found.properties.shaft.title} in {found.scene.name}: {situation.name}"


def scene_text(found: SceneRotor) -> str:
    """All figures as text."""
    lines = [report_text(found.properties)]
    for situation in found.support_conditions:
        lines += ["", *_situation(situation)]
    return "\n".join([*lines, *(f"  {line}" for line in found.unheld)])


def _map(model: RotorModel, situation: SupportCondition) -> CriticalMap | None:
    """Critical speeds over the stiffness of a situation's bearings, theirs marked; None: at one node."""
    nodes = dict.fromkeys(b.node for b in situation.bearings)
    if len(nodes) < 2:
        return None
    supports = tuple(_support(node, [b for b in situation.bearings if b.node == node]) for node in nodes)
    shaft: Shaft = replace(model.shaft, supports=supports)
    held_by = {b.station for b in situation.bearings}
    places = [s for s in shaft.stations if s.name in held_by]
    return critical_map(shaft, fullest(shaft, list(nodes)), places)


def _support(node: int, bearings: list[Bearing]) -> Support:
    """The springs that bearings at a node are."""
    across, upright = np.diag(static_stiffness(p for b in bearings for p in b.parts)).tolist()
    alike = abs(across - upright) <= ISOTROPY_TOLERANCE * max(abs(across), abs(upright))
    return Support(node, across, None if alike else upright)


# -- as text -----------------------------------------------------------------------------------------


def _situation(situation: SupportCondition) -> Iterator[str]:
    yield f"  {situation.name}"
    for bearing in situation.bearings:
        yield from _pressed(bearing) if bearing.pressed is not None else _floating(bearing)
    for line in situation.left_out:
        yield f"    {line}"
    yield ""
    yield from held_lines(situation.held, situation.name)


def _floating(b: Bearing) -> Iterator[str]:
    """One that holds the rotor where it starts: its laws, and what they are at each frequency."""
    several = len(b.answers) > 1
    looks = f", sees the rotor at {b.sensor}" if b.sensor else ""
    yield f"    {b.name} at {b.station}{looks}{_on(b)}"
    for answer in b.answers:
        if several:
            yield f"      as the rotor moves at {b.sensor if answer.sensed else b.station}:"
        yield from _law(answer)


def _law(answer: Answer) -> Iterator[str]:
    """The response of a bearing to one motion."""
    law, response = answer.law, answer.response
    lag = f", behind a lag of {1e6 * law.lag:.4g} us ({1.0 / law.lag:.5g} rad/s)" if law.lag else ""
    yield f"      {_both(law.stiffness, 'N/m')}, {_both(law.damping, 'N s/m')}{lag}"
    if law.misfit > MISFIT_LIMIT:
        yield f"      off by up to {percent(law.misfit, 2)} of what it answers, as the modes may be"
    if law.lag or law.misfit > MISFIT_LIMIT:
        yield "      at " + "".join(f"{f:11.0f} Hz" for f in response.frequencies)
        yield "      N/m" + "".join(f"{k:13.4g} " for k in response.real[:, 0])[1:]
        yield "      N s/m" + "".join(f"{c:13.4g} " for c in response.damping[:, 0])[3:]


def _both(matrix: np.ndarray, unit: str) -> str:
    """A matrix (2, 2) in words."""
    (a, b), (c, d) = matrix
    text = f"{a:.4g} {unit}" if a == d else f"{a:.4g} {unit} horizontally, {d:.4g} {unit} vertically"
    return text if b == c == 0.0 else f"{text} (across: {b:.4g}, {c:.4g} {unit})"


def _pressed(b: Bearing) -> Iterator[str]:
    """One that the rotor lies on."""
    assert b.pressed is not None
    depth = f"{1e6 * b.pressed.depth:.4g} um below its middle"
    yield f"    {b.name} at {b.station}, pressed with {b.load:.4g} N, {depth}{_on(b)}"
    yield (
        f"      {b.pressed.along:.4g} N/m and {b.pressed.damping:.4g} N s/m vertically, "
        f"{b.pressed.across:.4g} N/m to the side, where the bore rises; friction left out"
    )
    if b.foundation is not None:
        yield f"      with what it stands on in series: {b.statically[1, 1]:.4g} N/m vertically"


def _on(b: Bearing) -> str:
    """The support of the mount."""
    f = b.foundation
    if f is None:
        return ""
    return f", on {b.mount} ({f.mass:.4g} kg, {f.stiffness:.4g} N/m, {f.damping:.4g} N s/m)"
