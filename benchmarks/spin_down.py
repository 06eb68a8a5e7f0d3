"""What a long spin-down costs, and whether its energy closes: the disk, with gaps by heat and spin.

From 36 000 rpm on for ten minutes; the balls' drag is all that brakes it. SKF's coefficient makes 0.001 of
it; by default it is more, so that the rotor comes to rest. Every macro step is taken, there are no longer
strides. Times are of the processor.

    python benchmarks/spin_down.py [--duration 600] [--resistance 0.006] [--cold]
"""

from __future__ import annotations

import argparse
from time import process_time

import numpy as np

import touchdown
from touchdown.master.scene.scene import Scene

SCENE, RPM, ROWS = "disk-caged-simplified", 36_000.0, 400
MACRO_STEP = 50e-6  # s
AT_REST = 1.0  # rpm
GAPS, PARTS = ("play", "clearance"), ("journal", "inner", "balls", "outer", "housing")


def spin_down(duration: float, resistance: float, follows: bool) -> Scene:
    """The scene; follows: whether gaps follow heat and spin."""
    return touchdown.load(SCENE).set(
        {
            "rotor.speed": f"{RPM} rpm",
            "run.duration": duration,
            "run.macro_step": MACRO_STEP,
            "run.record_every": max(1, round(duration / MACRO_STEP / ROWS)),
            "run.record_also": ["bearing.gaps", "bearing.temperature"],
            "bearing.rolling.resistance": resistance,
            "bearing.rolling.f1": 0.0,
            "bearing.thermal": int(follows),
            "bearing.ring.growth": int(follows),
        }
    )


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--duration", type=float, default=600.0, help="s")
    parser.add_argument("--resistance", type=float, default=0.006, help="rolling.resistance")
    parser.add_argument("--cold", action="store_true", help="gaps stay as they are at the start")
    options = parser.parse_args()
    scene = spin_down(options.duration, options.resistance, not options.cold)
    begun = process_time()
    result = touchdown.run(scene, in_process=True, pictures=False)
    spent = process_time() - begun
    data = result.recording
    energy = sum(np.asarray(data[name]) for name, _ in data.columns() if ".energy." in name)
    speed = np.asarray(data["rotor.A.omega"])
    rpm = speed * 60.0 / (2.0 * np.pi)
    off = float(energy[-1] - energy[0]) / float(data["rotor.energy.kinetic"][0])
    print(f"{options.duration:g} s simulated, {spent:.1f} s of processor time")
    resting = data.time[np.abs(rpm) < AT_REST]
    rest = f", at rest after {resting[0]:.0f} s" if len(resting) else ""
    print(f"from {rpm[0]:.0f} to {rpm[-1]:.0f} rpm{rest}")
    print(f"heat in the bearing: {result.summary['seats']['A']['bearing_heat']:.4g} J")
    print(f"energy made or lost, of the rotor's at the start: {off:+.1e}")
    for gap in GAPS:
        values = 1e6 * np.asarray(data[f"bearing.gaps.{gap}"])
        ends = f"least {values.min():.2f}, most {values.max():.2f}, at the end {values[-1]:.2f}"
        print(f"{gap}: {values[0]:.2f} um, {ends}")
    warmest = (f"{part} {float(np.max(data[f'bearing.temperature.{part}'])):.3g}" for part in PARTS)
    print(f"highest temperatures above the start [K]: {', '.join(warmest)}")
    print("\n".join(result.warnings))


if __name__ == "__main__":
    main()
