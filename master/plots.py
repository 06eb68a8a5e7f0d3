"""Pictures of a run: which of them there are, and their files."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from matplotlib.figure import Figure

from master.connections import Attachment
from master.figures_contacts import contacts, has_contacts
from master.figures_energy import energy
from master.figures_forces import forces
from master.figures_motion import orbit, speeds
from master.figures_orbits import orbits
from master.figures_spectrum import has_spectrum, spectrum
from master.figures_stress import has_stress, stress
from master.figures_waterfall import has_waterfall, motion_waterfall
from master.recording import Recording
from master.scene import Scene
from master.stress_figures import stressed
from master.summary import energy_total, touchdown_seats
from master.system import System


def draw_all(scene: Scene, system: System, recording: Recording, folder: Path) -> list[Path]:
    """Draw what the scene is about into `folder`; returns the files."""
    made: list[Path] = []
    seats = touchdown_seats(system)
    for a in seats:
        tail = f"-{a.bearing}" if len(seats) > 1 else ""
        for name, figure in _of_bearing(scene, system, recording, a).items():
            made.append(_save(figure, folder / f"{name}{tail}.png"))
    if len(seats) > 1:
        made.append(_save(orbits(scene, system, recording, seats), folder / "orbits.png"))
    rotors = stressed(system)
    for name in rotors:
        tail = f"-{name}" if len(rotors) > 1 else ""
        if has_stress(system, name):
            made.append(_save(stress(scene, system, recording, name), folder / f"stress{tail}.png"))
    if energy_total(system, recording) is not None:
        made.append(_save(energy(scene, system, recording), folder / "energy.png"))
    return made


def _of_bearing(scene: Scene, system: System, recording: Recording, a: Attachment) -> dict[str, Figure]:
    """Figures of one touchdown bearing by the name of their file."""
    made = {
        "orbit": orbit(scene, system, recording, a),
        "force": forces(scene, system, recording, a),
    }
    if f"{a.bearing}.speed.ring" in recording:
        made["speeds"] = speeds(scene, system, recording, a)
    if has_contacts(system, a):
        made["contacts"] = contacts(scene, system, recording, a)
    if has_spectrum(recording, a):
        made["spectrum"] = spectrum(scene, recording, a)
    if has_waterfall(recording, a):
        made["waterfall"] = motion_waterfall(scene, recording, a)
    return made


def _save(figure: Figure, path: Path) -> Path:
    figure.savefig(path, dpi=110)
    return path
