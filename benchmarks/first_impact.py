"""Whether the first impact of a drop is the same in finer steps inside a bearing whose balls rattle before.

`disk-caged-detailed` from the start of the run, in which balls and cage rattle for 8 ms before the rotor
lands, at first angles of the balls over one pitch: largest force on a ball and in a pocket, in the default
steps against adaptive ones of the same tolerance, and against the default ones with the balls turned by
1e-3 rad. Where the two differ alike, the difference is that of another drop, not of the steps.

    python benchmarks/first_impact.py [ANGLES]
"""

from __future__ import annotations

import sys

import numpy as np

import touchdown

SCENE, COUNT, DURATION = "disk-caged-detailed", 9, "9.5 ms"  # balls in the scene
PEAKS = {"most loaded ball": "bearing.balls.peak_force", "in a pocket": "bearing.pockets.peak_force"}
TURNED = 1e-3  # rad


def peaks(angle: float, **settings: float) -> np.ndarray:
    """Of a drop whose first ball lies at an angle (rad), in N, (2,)."""
    drop = {"bearing.balls.first_angle": angle, "run.duration": DURATION}
    drop |= {f"bearing.{name}": value for name, value in settings.items()}
    data = touchdown.run(touchdown.load(SCENE).set(drop), in_process=True).data
    return np.array([float(data[name][-1]) for name in PEAKS.values()])


def main() -> None:
    """Print a row of each kind of difference: median, 90 % and largest of all angles, and the mean."""
    angles = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    off = np.empty((2, angles, len(PEAKS)))
    for k in range(angles):
        angle = -0.5 * np.pi + 2.0 * np.pi / COUNT * k / angles
        as_shipped = peaks(angle)
        off[0, k] = 100.0 * (as_shipped / peaks(angle, micro_step=0.0) - 1.0)
        off[1, k] = 100.0 * (as_shipped / peaks(angle + TURNED) - 1.0)
    print(f"{SCENE}, {angles} angles, %: median / 90 % / largest, mean with its sign and standard error")
    for what, values in zip(("against adaptive steps", f"turned by {TURNED:g} rad"), off, strict=True):
        size, error = np.abs(values), np.std(values, axis=0, ddof=1) / np.sqrt(angles)
        for k, name in enumerate(PEAKS):
            shares = " / ".join(f"{np.quantile(size[:, k], q):.2g}" for q in (0.5, 0.9, 1.0))
            mean = f"{np.mean(values[:, k]):+.2g} +- {error[k]:.2g}"
            print(f"{what:24}{name:20}{shares:>20}{mean:>20}")


if __name__ == "__main__":
    main()
