"""Rotor I hit by two bearings at once: peaks at the scenes' macro steps, against finer and adaptive steps.

Nine drops, by scene and phase of the unbalance, up to 8 ms after the shutdown; peak forces of both contacts
and both stresses, against macro steps of 1 us with adaptive steps inside the bearings. With macro steps
that are divided while both bearings are hit (`run.impact_step`), and without.

    python benchmarks/impact_peaks.py [MACRO_STEP ...]
"""

from __future__ import annotations

import sys

import numpy as np

import touchdown

DROPS = [("rotor1-9000", angle) for angle in (0, 72, 144, 216, 288)] + [
    ("rotor1-18000-150um", angle) for angle in (40, 130, 220, 310)
]
PEAKS = {
    "contact at A": "seats.A.peak_contact_force",
    "contact at B": "seats.B.peak_contact_force",
    "bending": "components.rotor.peak_bending_stress",
    "shear": "components.rotor.peak_shear_stress",
}
ADAPTIVE = {"bearing_A.micro_step": 0.0, "bearing_B.micro_step": 0.0}
FINE = {"run.macro_step": "1 us", "run.impact_step": 0.0} | ADAPTIVE


def peaks(changes: dict[str, object]) -> np.ndarray:
    """Of all drops with settings changed, (9, 4): N, N, Pa, Pa."""
    found: list[list[float]] = []
    for name, angle in DROPS:
        drop: dict[str, object] = {
            "run.duration": "8 ms",
            "rotor.unbalance_angle": f"{angle} deg",
            "rotor.stress.active": 1,
        }
        flat = touchdown.run(touchdown.load(name).set(drop | changes), in_process=True).flat
        found.append([flat[path] for path in PEAKS.values()])
    return np.array(found)


def said(errors: np.ndarray) -> str:
    """A column for each peak of the errors (9, 4): rms, largest, and that of the first drop."""
    rms, largest = np.sqrt((errors**2).mean(axis=0)), np.abs(errors).max(axis=0)
    told = zip(rms, largest, errors[0], strict=True)
    return "".join(f"{f'{r:.2f} / {x:.2f} / {e:+.2f}':>22}" for r, x, e in told)


def main() -> None:
    """Print the table: root mean square and largest of the drops' errors, and the first drop's."""
    right = peaks(FINE)
    print("error of peaks, %: rms of nine drops / largest / rotor1-9000 as it is shipped")
    print(f"{'macro step':<11}{'divided':>10}{'inside':>10}" + "".join(f"{name:>22}" for name in PEAKS))
    for step in sys.argv[1:] or ("40 us", "20 us", "10 us"):
        for divided in (0.0, "1 us"):
            for inside, changes in (("2 us", {}), ("adaptive", ADAPTIVE)):
                settings = {"run.macro_step": step, "run.impact_step": divided}
                errors = said(100.0 * (peaks(settings | changes) / right - 1.0))
                print(f"{step:<11}{divided or 'no':>10}{inside:>10}{errors}", flush=True)


if __name__ == "__main__":
    main()
