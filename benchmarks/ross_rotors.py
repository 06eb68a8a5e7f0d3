"""ROSS's published example rotors, imported: their modes by ROSS and by us, free and on their bearings.

    python benchmarks/ross_rotors.py [-o FOLDER]

needs ROSS (`pip install ross-rotordynamics "plotly<6"`). Each example is saved by `rotor.save` and imported
by one command, and besides by the matrices M, K and G of the free rotor alone. ROSS's own matrices are
solved here without its axial and torsional coordinates, undamped, and with all coefficients of its
bearings, damping and cross-coupling, as complex roots ("damped"); `run_modal` and `run_ucs` (critical
speeds over the stiffness of the bearings) are solved as they are. Besides: the first example on bearings
that stand on masses of their own, and ROSS's test rig on its magnetic bearings, whose coefficients are
those at the frequency of the spin. With -o it leaves saved files, matrices and ROSS's figures in FOLDER,
which is how validation/ross came to be.
"""

from __future__ import annotations

import argparse
import io
import json
import math
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import ross

import touchdown
from touchdown.command.cli import main as command
from touchdown.rotor.beams.shaft import Support
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.modal.supported import HeldRotor, LinearBearing

EXAMPLES = ("rotor_example", "rotor_example_with_damping", "compressor_example")
SPEEDS = (0.0, 6000.0, 12000.0)  # rpm
MODES = 12  # six, backward and forward
STIFFNESS = (5, 9, 5)  # decades of N/m, and how many
RIG = "rotor_amb_example"
SUPPORT = {"mass": 20.0, "kxx": 5e7, "cxx": 2e3}  # kg, N/m, N s/m, under each bearing
BEARING = {"kxx": 1e7, "kyy": 8e6, "cxx": 1e3, "cyy": 800.0}
STILL = 1.0  # rad/s; below, a free rotor does not bend


def ross_modes(rotor: ross.Rotor, speed: float) -> np.ndarray:
    """Undamped lateral whirl frequencies (Hz), ascending, at `speed` (rad/s), of ROSS's matrices."""
    keep = [6 * node + i for node in range(len(rotor.nodes)) for i in (0, 1, 3, 4)]
    M, K, G = (m[np.ix_(keep, keep)] for m in (rotor.M(speed), rotor.K(speed), rotor.G()))
    inverse = np.linalg.inv(M)
    zero, one = np.zeros_like(M), np.eye(len(M))
    found = np.linalg.eigvals(np.block([[zero, one], [-inverse @ K, -speed * inverse @ G]])).imag
    return np.sort(found[found > STILL])[:MODES] / (2.0 * math.pi)


def our_modes(rotor: touchdown.Rotor, speed: float, supports: tuple[Support, ...]) -> np.ndarray:
    """The same of ours on the springs of `supports`."""
    springs = [replace(s, damping=0.0, damping_y=0.0) for s in supports]
    found = frequencies(rotor, speed, springs)
    return np.sort(found[found > STILL / (2.0 * math.pi)])[:MODES]


def frequencies(rotor: touchdown.Rotor, speed: float, supports: Sequence[Support]) -> np.ndarray:
    """Damped (Hz), of all modes of ours on `supports` at `speed` (rad/s)."""
    return (
        HeldRotor(basis(rotor, 0), [LinearBearing.of(s) for s in supports]).damped_modes(speed).frequencies
    )


def ross_roots(free: ross.Rotor, held: ross.Rotor, speed: float) -> np.ndarray:
    """Complex roots (1/s) of ROSS's matrices, by size, damped by its bearings alone."""
    nodes, links = len(held.nodes), len(held.link_nodes)
    keep = [6 * node + i for node in range(nodes) for i in (0, 1, 3, 4)]
    keep += [6 * nodes + 3 * link + i for link in range(links) for i in (0, 1)]
    damping = held.C(speed)
    damping[: free.ndof, : free.ndof] -= free.C(speed)
    matrices = (held.M(speed), held.K(speed), damping + speed * held.G())
    M, K, C = (m[np.ix_(keep, keep)] for m in matrices)
    inverse = np.linalg.inv(M)
    zero, one = np.zeros_like(M), np.eye(len(M))
    return swinging(np.linalg.eigvals(np.block([[zero, one], [-inverse @ K, -inverse @ C]])))


def our_roots(held: ross.Rotor, rotor: touchdown.Rotor, speed: float) -> np.ndarray:
    """The same of ours in bearings of the same coefficients."""
    bearings = [
        LinearBearing(b.n + 1, b.K(speed)[:2, :2], b.C(speed)[:2, :2]) for b in held.bearing_elements
    ]
    return swinging(HeldRotor(basis(rotor, 0), bearings).damped_modes(speed).roots)


def swinging(roots: np.ndarray) -> np.ndarray:
    """The lowest of each conjugate pair."""
    roots = roots[roots.imag > STILL]
    return roots[np.argsort(np.abs(roots))][:MODES]


def apart_roots(free: ross.Rotor, held: ross.Rotor, rotor: touchdown.Rotor, speed: float) -> str:
    """How far each of our roots is from the nearest of ROSS's, over its size; the largest."""
    theirs, ours = ross_roots(free, held, speed), our_roots(held, rotor, speed)
    return f"{max(np.min(np.abs(theirs / one - 1.0)) for one in ours):.1e}"


def bending(frequencies: np.ndarray, rotor: touchdown.Rotor) -> np.ndarray:
    """Without the free rotor's precession."""
    return frequencies[frequencies > 0.5 * rotor.frequencies(3)[2]]


def main() -> None:
    """Print a line for each example and speed."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("-o", "--output", type=Path)
    folder = options.parse_args().output
    print(
        f"ROSS {ross.__version__}; largest relative deviation of {MODES // 2} modes, backward and forward"
    )
    columns = (
        f"{'free':>10}{'matrices':>10}{'on bearings':>13}{'damped':>10}{'run_modal':>11}{'run_ucs':>10}"
    )
    print(f"{'example':28}{'rpm':>7}{columns}")
    with TemporaryDirectory() as temporary:
        told = {name: compared(name, folder or Path(temporary)) for name in EXAMPLES}
        kept = {"ross": ross.__version__, "hz": told, "supports": supported()}
        kept["magnetic"] = levitated(folder or Path(temporary))
    if folder:
        (folder / "frequencies.json").write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def compared(name: str, folder: Path) -> dict[str, dict[str, list[float]]]:
    """Print the lines of an example; returns ROSS's frequencies (Hz), free and on bearings, by speed."""
    original = getattr(ross, name)()
    free = ross.Rotor(original.shaft_elements, original.disk_elements)
    bearings = [b for b in original.bearing_elements if not isinstance(b, ross.SealElement)]
    held = ross.Rotor(original.shaft_elements, original.disk_elements, bearings)
    saved = folder / f"{name}.toml"
    saved.unlink(missing_ok=True)
    original.save(saved)
    told: dict[str, dict[str, list[float]]] = {"free": {}, "held": {}}
    for rpm in SPEEDS:
        speed = rpm * math.pi / 30.0
        rotor = imported(saved, rpm)
        theirs = {"free": bending(ross_modes(free, speed), rotor), "held": ross_modes(held, speed)}
        ours = {"free": bending(our_modes(rotor, speed, ()), rotor)}
        alone = bending(our_modes(from_matrices(free, folder / f"{name}.npz"), speed, ()), rotor)
        if "cross-coupled" not in rotor.about:
            ours["held"] = our_modes(rotor, speed, rotor.supports)
        apart = {kind: f"{np.max(np.abs(ours[kind] / theirs[kind] - 1.0)):.1e}" for kind in ours}
        taken = f"{np.max(np.abs(alone / theirs['free'] - 1.0)):.1e}"
        damped = apart_roots(free, held, rotor, speed)
        for kind in ours:
            told[kind][f"{rpm:g}"] = theirs[kind].tolist()
        row = f"{name:28}{rpm:7.0f}{apart['free']:>10}{taken:>10}{apart.get('held', '-'):>13}{damped:>10}"
        print(f"{row}{run_modal(held, rotor, speed):>11}", end="\n" if rpm else "")
        if not rpm:
            told["critical"], line = critical(original, rotor)
            print(line)
    return told


def supported() -> dict[str, object]:
    """Roots (1/s) of the first example on bearings that stand on masses, by speed (rpm)."""
    original = ross.rotor_example()
    link = len(original.nodes)
    ends = [b.n for b in original.bearing_elements]
    free = ross.Rotor(original.shaft_elements, original.disk_elements)
    bearings = [ross.BearingElement(n=n, n_link=link + k, **BEARING) for k, n in enumerate(ends)]
    springs = {name: SUPPORT[name] for name in ("kxx", "cxx")}
    bearings += [ross.BearingElement(n=link + k, **springs) for k in range(len(ends))]
    masses = [ross.PointMass(n=link + k, m=SUPPORT["mass"]) for k in range(len(ends))]
    held = ross.Rotor(original.shaft_elements, original.disk_elements, bearings, masses)
    return {"support": SUPPORT, "bearing": BEARING, "roots": rooted(free, held)}


def levitated(folder: Path) -> dict[str, object]:
    """ROSS's test rig: factors of its magnets, its free modes (Hz), and its roots (1/s) while levitated."""
    original = getattr(ross, RIG)()
    free = ross.Rotor(original.shaft_elements, original.disk_elements)
    saved = folder / f"{RIG}.toml"
    saved.unlink(missing_ok=True)
    free.save(saved)
    rotor = imported(saved, 0.0)
    bearing = original.bearing_elements[0]
    numbers = ("n", "g0", "ag", "nw", "i0", "alpha", "kp_pid", "kd_pid", "n_f")
    return {
        "bearing": {name: float(getattr(bearing, name)) for name in numbers},
        "nodes": [b.n for b in original.bearing_elements],
        "k_i": float(bearing.ki),
        "k_s": float(bearing.ks),
        "free": {
            f"{rpm:g}": bending(ross_modes(free, rpm * math.pi / 30.0), rotor).tolist() for rpm in SPEEDS
        },
        "roots": rooted(free, original, SPEEDS[1:]),
    }


def rooted(free: ross.Rotor, held: ross.Rotor, speeds: Sequence[float] = SPEEDS) -> dict[str, list]:
    """ROSS's roots (1/s) as pairs, by speed (rpm)."""
    found = {f"{rpm:g}": ross_roots(free, held, rpm * math.pi / 30.0) for rpm in speeds}
    return {rpm: [[one.real, one.imag] for one in roots] for rpm, roots in found.items()}


def from_matrices(free: ross.Rotor, path: Path) -> touchdown.Rotor:
    """A rotor of ROSS's matrices, by way of the archive at `path`."""
    np.savez_compressed(
        path,
        M=free.M(0.0),
        K=free.K(0.0),
        G=free.G(),
        coordinates=np.array(free.nodes_pos, dtype=float),
        dofs=["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"],
    )
    return touchdown.import_rotor(path)


def critical(original: ross.Rotor, rotor: touchdown.Rotor) -> tuple[dict[str, list[float]], str]:
    """Critical speeds (rad/s) by the stiffness of the bearings, ROSS's; and how far ours are from them."""
    low, high, count = STIFFNESS
    found = original.run_ucs((low, high), num=count, num_modes=16, synchronous=True).wn.T
    theirs = {f"{k:g}": row.tolist() for k, row in zip(np.logspace(low, high, count), found, strict=True)}
    ours = [
        rotor.critical_speeds({s.name: float(k) for s in rotor.stations})[: found.shape[1]] for k in theirs
    ]
    return theirs, f"{np.max(np.abs(np.array(ours) / found - 1.0)):10.1e}"


def imported(saved: Path, rpm: float) -> touchdown.Rotor:
    """By the command, from what ROSS saved."""
    with TemporaryDirectory() as temporary, redirect_stdout(io.StringIO()):
        path = str(Path(temporary) / "imported.toml")
        assert command(["import", "rotor", str(saved), "-o", path, "--speed", f"{rpm} rpm"]) == 0
        return touchdown.Rotor.load(path)


def run_modal(held: ross.Rotor, rotor: touchdown.Rotor, speed: float) -> str:
    """How far ROSS's own damped modes are from ours, where nothing is left out of the import."""
    if len(rotor.about.splitlines()) > 1:
        return "-"
    theirs = held.run_modal(speed, num_modes=4 * MODES, sparse=False).wd / (2.0 * math.pi)
    ours = frequencies(rotor, speed, rotor.supports)[: MODES // 2]
    return f"{max(np.min(np.abs(theirs / one - 1.0)) for one in ours):.1e}"


if __name__ == "__main__":
    main()
