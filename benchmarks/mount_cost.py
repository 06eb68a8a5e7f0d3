"""What a mount costs beside a housing, in microseconds of processor time a macro step.

Both carry the same load, which goes round at 100 Hz, for macro steps of 20 us; the call from Python is the
same for both and falls out of the difference. Medians of interleaved turns.

    python benchmarks/mount_cost.py
"""

from __future__ import annotations

import math
import statistics
from time import process_time

from touchdown.bearings.supports import housing, mount
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model

STEP, STEPS, TURNS = 20e-6, 20_000, 9
LOAD, RATE = 2000.0, 2.0 * math.pi * 100.0  # N, rad/s
SOFT: dict[str, float] = {
    **dict.fromkeys(("spring.xx", "spring.yy"), 1e7),
    **dict.fromkeys(("damper.xx", "damper.yy"), 100.0),
    "mass": 0.5,
}
SLIDE = {"slide[1].stiffness": 2e7, "slide[1].force": 200.0}
STOP = {"stop.gap": 100e-6, "stop.stiffness": 1e10}
FILM = {"film.radius": 0.03, "film.length": 0.03, "film.viscosity": 0.01}
MOUNTS: dict[str, dict[str, float]] = {
    "linear, as the housing": {},
    "linear, soft": SOFT,
    "soft, rubber": {**SOFT, "branch[1].stiffness": 1e7, "branch[1].time": 1e-3},
    "soft, a slide": {**SOFT, **SLIDE},
    "soft, a slide, stop hit": {**SOFT, **SLIDE, **STOP},
    "soft, film": {**SOFT, **FILM},
}


def started(model: Model, values: dict[str, float]) -> Instance:
    """A started instance with these parameters."""
    made = Instance(model)
    places = {slot.variable.name: slot for slot in made.slots}
    for name, value in values.items():
        made.store(places[name])[places[name].index] = value
    made.start(0.0)
    return made


def cost(made: Instance) -> float:
    """Processor time (us) of a macro step."""
    seat = made.record["u"]["seat"]
    seat = seat if made.model is housing.MODEL else seat[0]
    begun = process_time()
    for i in range(STEPS):
        angle = RATE * i * STEP
        seat["fx"], seat["fy"] = LOAD * math.cos(angle), LOAD * math.sin(angle)
        made.step(i * STEP, STEP)
    return 1e6 * (process_time() - begun) / STEPS


def main() -> None:
    """Print the table."""
    plain = started(housing.MODEL, {})
    print(f"{'mount':<26}{'more than a housing [us a macro step]':>40}")
    for title, values in MOUNTS.items():
        made = started(mount.MODEL, values)
        cost(plain), cost(made)
        more = [cost(made) - cost(plain) for _ in range(TURNS)]
        print(f"{title:<26}{statistics.median(more):>40.2f}", flush=True)


if __name__ == "__main__":
    main()
