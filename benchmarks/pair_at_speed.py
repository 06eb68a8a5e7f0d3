"""A preloaded pair through a spin-down: what growth, hoop compliance, centrifugal force and heat change.

The compressor is dropped at 32 000 rpm and braked to standstill. Each row leaves one effect out; the last
ones have play along the shaft in place of the preload.

    python benchmarks/pair_at_speed.py [--duration 60] [--torque 0.95] [--jobs 2]
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import touchdown
from touchdown.master.scene.spin_down import spin_down

EFFECTS: Mapping[str, object] = {
    "ring.growth": 1, "ring.hoop": 1, "outer_ring.seat": "loose", "balls.centrifugal": 1, "thermal": 1,
}  # fmt: skip
VARIANTS: Mapping[str, Mapping[str, object]] = {
    "all": {},
    "without hoop compliance": {"ring.hoop": 0},
    "without centrifugal force of balls": {"balls.centrifugal": 0},
    "without growth by spin": {"ring.growth": 0},
    "without heat": {"thermal": 0},
    "all, 10 um of play along the shaft": {"preload": 0.0, "interference": "-10 um"},
    "all, 30 um of play along the shaft": {"preload": 0.0, "interference": "-30 um"},
}


def row(name: str, duration: float, torque: float) -> str:
    """A line of the table."""
    changes = {f"bearing_A.{key}": value for key, value in {**EFFECTS, **VARIANTS[name]}.items()}
    changes |= {"bearing_B.thermal": changes["bearing_A.thermal"]}
    changes |= {"rotor.brake_points": 1, "rotor.brake[1].torque": torque}
    result = touchdown.run(spin_down(touchdown.load("compressor").set(changes), duration), in_process=True)
    seat, summary = result.summary["seats"]["A"], result.summary
    warm = [
        seat.get(key) for key in ("temperature_rise_inner", "temperature_rise_balls", "contact_temperature")
    ]
    energy = summary["energy_balance_relative"] * summary["energy_scale"] / summary["energy_turnover"]
    figures = [
        "no" if seat.get("seized_time") is None else f"{seat['seized_time']:.3g} s",
        f"{seat['peak_ball_force']:.0f}",
        *("-" if kelvin is None else f"{kelvin:.0f}" for kelvin in warm),
        "to the end" if summary.get("valid_until") is None else f"{summary['valid_until']:.3g} s",
        f"{summary['end_time']:.3g}",
        f"{abs(energy):.0e}",
        f"{summary['wall_time_per_simulated_second']:.2g}",
    ]
    return f"| {name} | " + " | ".join(figures) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=60.0, help="s")
    parser.add_argument("--torque", type=float, default=0.95, help="N m, of the brake")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    print(
        "| effects | ring seizes | largest ball load, N | inner ring, K | balls, K | bore, K | valid | "
        "end, s | energy error of turnover | wall s per s |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    with ProcessPoolExecutor(args.jobs) as pool:
        for line in pool.map(partial(row, duration=args.duration, torque=args.torque), VARIANTS):
            print(line, flush=True)


if __name__ == "__main__":
    main()
