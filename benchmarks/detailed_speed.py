"""Speed of the detailed bearings against error: kernels, integrators, whole drops, other codes.

All ratios come from one run on one core. The drop starts at first touch with the bearing at rest, where
the first impact is not yet chaotic; errors are those of its peak forces (rotor on ring, most loaded ball)
within 1.5 ms, against adaptive steps at a tolerance of 1e-9. Whole drops are 5 s from the shutdown.

    python benchmarks/detailed_speed.py [--repeat 3] [--no-drops]

EXUDYN takes part where it is installed (pip install exudyn).
"""

from __future__ import annotations

import argparse
import statistics
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from scipy.integrate import solve_ivp
from tried_integrators import make, whole

from touchdown.bearings import detailed_caged, detailed_cageless, seat
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE, ContactPlace, contact_in_kick, kick_of
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_bodies import ball_motion, press_races, rub_ball_races
from touchdown.bearings.rolling.micro_step import MICRO_STEP, RESOLUTION, beat_of
from touchdown.bearings.seat import space
from touchdown.bearings.seat import step as plane
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.scene.file import load_scene
from touchdown.modelkit.instance import Instance

MODULES = {"cageless": detailed_cageless, "caged": detailed_caged}
IMPACT = 1.5e-3  # s
STRETCH = 20e-3  # s, over which integrators are timed
ALLOWED = 0.01  # error of the peaks


def released(module: ModuleType, falling: bool = False) -> Instance:
    """A bearing that carries disk and housing itself, at first touch, or 0.3 mm before it (`falling`)."""
    instance = Instance(module.MODEL)
    m = instance.memory
    journal, housing = m["u"]["journal"], m["u"]["housing"]
    if not falling:
        journal["y"], journal["vy"] = -0.29999e-3, -0.0767
    journal["omega"], journal["ay_free"] = 942.478, -9.81
    journal["inv_m"], journal["inv_I"] = 1.0 / 1.65, 2000.0
    housing["inv_m"], housing["k_over_m"], housing["c_over_m"] = 1 / 5.02, 2.5e8 / 5.02, 2500 / 5.02
    instance.start(0.0)
    return instance


def peaks(instance: Instance) -> np.ndarray:
    """(Rotor on ring, most loaded ball) peak forces (N)."""
    o = instance.record["o"]
    return np.array([o["contact"]["peak_force"], o["balls"]["peak_force"]])


@dataclass(frozen=True)
class Runner:
    """Advances a bearing in one go: carry(words, rows, span, step, tolerance) -> evaluations."""

    label: str
    carry: Callable
    step: float = 0.0
    tolerance: float = 0.0

    def run(self, module: ModuleType, span: float, falling: bool = False) -> tuple[Instance, float, int]:
        """(The bearing after `span` s, wall time in s, evaluations)."""
        instance = released(module, falling)
        work = np.zeros((8, module.MEMORY["q"].shape[0]))
        began = clock.perf_counter()
        evaluations = self.carry(instance.words, work, span, self.step, self.tolerance)
        return instance, clock.perf_counter() - began, evaluations


def carrier(module: ModuleType, tried: Callable) -> Callable:
    """`tried` on a bearing's words."""
    memory, scratch = module.MEMORY, module.SCRATCH

    @whole
    def carry(words, work, span, step, tolerance):
        m = words.view(memory)[0]
        return tried(m, work.ravel().view(scratch)[0].rows, span, step, tolerance)

    return carry


def kept(module: ModuleType) -> Callable:
    """The models' own integrator, in stretches of 10 ms."""
    react, integrate, memory, scratch = module.react, module.integrate, module.MEMORY, module.SCRATCH
    is_spatial = module.MODEL.inputs is space.SpatialInputs
    copy_rates = space.spatial_copy_rates if is_spatial else seat.copy_rates
    remember = space.remember_spatial_load if is_spatial else plane.remember_load

    @whole
    def carry(words, work, span, step, tolerance):
        m = words.view(memory)[0]
        rows = work.ravel().view(scratch)[0].rows
        m.d.micro_step = step
        m.d.resolution = RESOLUTION * min(step / MICRO_STEP, 1.0)
        m.s.kick = 0.5 * step
        m.p.interface.tolerance = max(tolerance, 1e-12)
        evaluations = 0
        for _ in range(max(round(span / 1e-2), 1)):
            load = react(0.0, m.q, rows[0], m)
            remember(m, load)
            copy_rates(0.0, m.q, rows[0], m, m.half, load)
            m.h, _, more = integrate(m, rows, min(span, 1e-2))
            evaluations += 1 + more
        return evaluations

    return carry


def repeater(module: ModuleType) -> Callable:
    """A kernel repeat(words, rows, times) that evaluates a model's right-hand side `times` over."""
    rhs, memory, scratch = module.rhs, module.MEMORY, module.SCRATCH

    @whole
    def repeat(words, rows, times):
        m = words.view(memory)[0]
        dq = rows.ravel().view(scratch)[0].rows[0]
        for _ in range(times):
            rhs(0.0, m.q, dq, m)

    return repeat


def rhs_time(module: ModuleType, repeat: int) -> tuple[float, int]:
    """(us per right-hand side, loaded balls) at the first impact's height."""
    instance = Runner("", kept(module), MICRO_STEP).run(module, 4e-4)[0]
    loop = repeater(module)
    work = np.zeros((8, module.MEMORY["q"].shape[0]))
    loop(instance.words, work, 10)
    found = []
    for _ in range(repeat):
        began = clock.perf_counter()
        loop(instance.words, work, 50_000)
        found.append((clock.perf_counter() - began) / 50_000 * 1e6)
    s, count = instance.record["s"], int(instance.record["p"]["balls"]["count"])
    pressed = (s["inner"]["normal"] > 0.0) & (s["outer"]["normal"] > 0.0)
    return statistics.median(found), int(np.sum(pressed[:count]))


def race_times(module: ModuleType) -> tuple[float, float]:
    """us for both races: all balls at once, and one by one with those out of reach skipped."""
    instance = Runner("", kept(module), MICRO_STEP).run(module, 4e-4)[0]
    layout = module.MEMORY
    one_race = one_by_one_at_a_race()

    @whole
    def at_once(words, work, count):
        m = words.view(layout)[0]
        total, dq = 0.0, work[0]
        for _ in range(count):
            press_races(m.q, m)
            total += rub_ball_races(m.q, dq, m)[1].fx
        return total

    @whole
    def one_by_one(words, work, count):
        m = words.view(layout)[0]
        total, d, s = 0.0, m.d, m.s
        for _ in range(count):
            total += one_race(m, seat.housing_motion(m.q), INSIDE, d.outer, s.outer)
            total += one_race(m, ring.ring_motion(m.q), OUTSIDE, d.inner, s.inner)
        return total

    found, work = [], np.zeros((1, layout["q"].shape[0]))
    for loop in (at_once, one_by_one):
        loop(instance.words, work, 10)
        began = clock.perf_counter()
        loop(instance.words, work, 50_000)
        found.append((clock.perf_counter() - began) / 50_000 * 1e6)
    return found[0], found[1]


def one_by_one_at_a_race() -> Callable:
    """The balls at one race as pairs of their own: friction meets the answer of its own ball alone."""

    @whole
    def one_race(m, body, side, law, s):
        total, d, rb, before = 0.0, m.d, m.d.ball_radius, m.s.before
        answers = 1.0 / d.mass + rb * rb / d.inertia, 1.0 / d.mass
        for b in range(m.p.balls.count):
            if s.indentation[b] > 0.0:
                at = ContactPlace(s.nx[b], s.ny[b], s.indentation[b], side * rb, s.second[b], s.across[b])
                faster = ball_motion(before, b, m)
                last = s.tangential[b], s.normal[b]
                kick = kick_of(beat_of(m), answers, faster, ring.ring_motion(before), at, side, last)
                total += contact_in_kick(
                    ball_motion(m.q, b, m), body, at, side, law, d.race_friction, kick
                ).fx
        return total

    return one_race


def runners(module: ModuleType) -> list[Runner]:
    """The kept integrator and those that were tried, each over its range."""
    steps = (0.5 * MICRO_STEP, MICRO_STEP, 2.0 * MICRO_STEP)
    found = [Runner("leapfrog, friction implicit (kept)", kept(module), h) for h in steps]
    for label, tried in make(module).items():
        carry = carrier(module, tried)
        if "adaptive" in label:
            found += [Runner(label, carry, 0.0, e) for e in (1e-3, 1e-4, 1e-5, 1e-6)]
        else:
            found += [Runner(label, carry, h) for h in (2e-7, 1e-6, 2e-6)]
    return found


def integrator_table(module: ModuleType, exact: np.ndarray, repeat: int) -> float:
    """Print what each integrator costs and errs; returns the kept one's wall time over simulated time."""
    print(
        f"{'integrator':<40}{'step':>8}{'tol.':>8}{'rotor':>10}{'ball':>10}{'evals/us':>10}{'wall/sim':>10}"
    )
    ours = 0.0
    for runner in runners(module):
        runner.run(module, 1e-5)  # compiles
        off = peaks(runner.run(module, IMPACT)[0]) / exact - 1.0
        runs = [runner.run(module, STRETCH) for _ in range(repeat)]
        cost = statistics.median(wall for _, wall, _ in runs) / STRETCH
        step = f"{runner.step * 1e6:g} us" if runner.step else ""
        tolerance = f"{runner.tolerance:g}" if runner.tolerance else ""
        print(f"{runner.label:<40}{step:>8}{tolerance:>8}", end="")
        if not np.all(np.abs(off) < 10.0):
            print(f"{'unstable':>20}")
            continue
        print(f"{100 * off[0]:>8.2g} %{100 * off[1]:>8.2g} %", end="")
        print(f"{runs[0][2] / STRETCH * 1e-6:>10.3g}{cost:>10.3g}")
        if "kept" in runner.label and runner.step == MICRO_STEP:
            ours = cost
    return ours


class Equations:
    """The same compiled right-hand side for scipy; `highest` are the peak forces of its last solution."""

    def __init__(self, module: ModuleType) -> None:
        rhs, layout, scratch = module.rhs, module.MEMORY, module.SCRATCH

        @whole
        def rate(words, work, state):
            m = words.view(layout)[0]
            rows = work.ravel().view(scratch)[0].rows
            rows[1][: m.n] = state
            m.s.kick = 0.0
            rhs(0.0, rows[1], rows[0], m)
            highest = 0.0
            for b in range(m.p.balls.count):
                highest = max(highest, m.s.inner.normal[b], m.s.outer.normal[b])
            return rows[0][: m.n].copy(), m.s.ring.normal, highest

        self._rate = rate
        self._instance = released(module)
        self._work = np.zeros((8, module.MEMORY["q"].shape[0]))
        n = int(self._instance.record["n"])
        self.start = self._instance.record["q"][:n].copy()
        weight = self._instance.record["weight"][:n]
        self._scale = np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), 1e9)
        self.highest = np.zeros(2)

    def __call__(self, t: float, state: np.ndarray) -> np.ndarray:
        return self._rate(self._instance.words, self._work, state)[0]

    def solve(self, method: str, tolerance: float, span: float) -> float:
        """Wall time (s) of scipy's `method` over `span` (s)."""
        began = clock.perf_counter()
        atol = tolerance * self._scale
        found = solve_ivp(
            self, (0.0, span), self.start, method=method, rtol=1e-12, atol=atol, first_step=1e-7
        )
        wall = clock.perf_counter() - began
        forces = [self._rate(self._instance.words, self._work, state)[1:] for state in found.y.T.copy()]
        self.highest = np.max(forces, axis=0)
        return wall


def scipy_table(module: ModuleType, exact: np.ndarray, ours: float) -> None:
    """scipy's solvers on the same compiled right-hand side, at the loosest tolerance within 1 %."""
    equations = Equations(module)
    for method in ("RK23", "RK45", "DOP853", "LSODA"):
        for tolerance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
            cost = equations.solve(method, tolerance, IMPACT) / IMPACT
            off = equations.highest / exact - 1.0
            if np.max(np.abs(off)) < ALLOWED:
                print(f"{'scipy ' + method:<40}{'':>8}{tolerance:>8g}", end="")
                print(f"{100 * off[0]:>8.2g} %{100 * off[1]:>8.2g} %{'':>10}{cost:>10.3g}", end="")
                print(f"   {cost / ours:.0f} times ours")
                break
        else:
            print(f"{'scipy ' + method:<40}not within {100 * ALLOWED:g} % at any tolerance tried")


def whole_drops(repeat: int) -> None:
    """5 s from the shutdown: monolithic in process, and through FMUs."""
    print(f"\nwhole drop of 5 s, wall time over simulated time, median of {repeat}")
    for name, module in MODULES.items():
        runner = Runner("", kept(module), MICRO_STEP)
        runner.run(module, 1e-5)
        mono = statistics.median(runner.run(module, 5.0, falling=True)[1] for _ in range(repeat)) / 5.0
        scene = load_scene(f"disk-{name}-detailed")
        costs = []
        for _ in range(repeat):
            system = open_system(scene)
            outcome = simulate(scene, system)
            system.close()
            costs.append(outcome.wall_time / outcome.end)
        fmus = statistics.median(costs)
        print(f"  {name:<10} monolithic {mono:.3g}, through FMUs {fmus:.3g} at ", end="")
        print(f"{scene.run.macro_step * 1e6:g} us: {fmus / mono:.2f} times the monolithic one")


def exudyn_row(ours: float) -> None:
    """The same drop in EXUDYN, where it is installed."""
    try:
        import exudyn_drop
    except ImportError:
        print("EXUDYN is not installed; pip install exudyn")
        return
    control = exudyn_drop.Control()
    result = exudyn_drop.drop("equal", control, STRETCH)
    print(
        f"EXUDYN, contacts in C++, {result.solver}: {result.wall_per_second:.3g} s per simulated s, ",
        end="",
    )
    print(f"peak {result.peak_force:.1f} N; {result.wall_per_second / ours:.0f} times ours")


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--no-drops", action="store_true", help="leave the 5 s drops out")
    options = parser.parse_args()
    costs = {}
    for name, module in MODULES.items():
        cost, loaded = rhs_time(module, options.repeat)
        at_once, one_by_one = race_times(module)
        print(f"\n{module.MODEL.title}: right-hand side {cost:.2f} us with {loaded} loaded balls")
        print(f"both races: all balls as vector code {at_once:.2f} us, ", end="")
        print(f"one by one, skipping those out of reach, {one_by_one:.2f} us")
        reference = Runner("", kept(module), 0.0, 1e-9)
        exact = peaks(reference.run(module, IMPACT)[0])
        print(f"reference: rotor on ring {exact[0]:.2f} N, most loaded ball {exact[1]:.2f} N; errors:")
        costs[name] = integrator_table(module, exact, options.repeat)
        scipy_table(module, exact, costs[name])
        if name == "cageless":
            exudyn_row(costs[name])
    if not options.no_drops:
        whole_drops(options.repeat)


if __name__ == "__main__":
    main()
