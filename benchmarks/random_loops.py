"""Random controllers and rotors: are stability, peaks, zones and delay margins of loops right?

Each case is looked at twice: by the project, and by another model, written here from the documented
equations. That takes of the rotor its natural frequencies and shapes and nothing else of the project: the
force law is differentiated by complex steps, the plant held from sample to sample by scipy, the controller
consists of polynomials in 1/z, and S is 1/(1 + P C) on a dense grid. Delay margins are judged by how often
1 + L winds around 0 with a bit more delay, and a bit less.

    .venv/bin/python benchmarks/random_loops.py --count 200
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.signal import cont2discrete

from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.studies.loop.linear_loops import Sampled
from touchdown.studies.loop.margins import ZONES, zone
from touchdown.studies.loop.over_speed import loops_in

SEED = 5
MU0 = 4e-7 * math.pi
BORDER = 1e-6  # of a limit of a zone, nearer to which zones may differ
NARROW = 1e-9  # a pole nearer to the circle is neither in nor out
COARSE, AROUND = 1000, 80  # lines, and those around each pole
BIT = 1e-4  # of a delay margin


@dataclass(frozen=True)
class Case:
    """A scene's settings by component, SI, and the rotor's file of a flexible one."""

    number: int
    rotor: str  # "": rigid
    settings: dict[str, dict[str, float]]
    magnets: int

    def scene(self, folder: Path) -> Scene:
        """The scene, with its rotor's file in `folder`."""
        kind = "rigid_rotor"
        if self.rotor:
            path = folder / f"rotor{self.number}.toml"
            path.write_text(self.rotor, encoding="utf-8")
            kind = str(path)
        components = {"rotor": ComponentSpec(kind, dict(self.settings["rotor"]))}
        places = ("A", "B")[: self.magnets]
        for name in places:
            components[f"amb_{name}"] = ComponentSpec("amb_actuator", dict(self.settings["amb"]))
            components[f"c_{name}"] = ComponentSpec("amb_controller", dict(self.settings["controller"]))
        ports = {"A": "rotor.amb_A", "B": "rotor.amb_B"} if self.rotor else {"A": "rotor.amb"}
        return Scene(
            f"case{self.number}",
            f"case {self.number}",
            components,
            attach=tuple((f"amb_{name}.journal", ports[name]) for name in places),
            control=tuple((f"c_{name}", f"amb_{name}") for name in places),
            run=with_changes(RunSpec(), {"macro_step": 2e-5}),
        )


def shaft(rng: np.random.Generator) -> tuple[str, float]:
    """A file of a random rotor: a stepped shaft, one or two discs, two magnets; its mass (kg)."""
    elements = int(rng.integers(8, 14))
    length, thickness = rng.uniform(0.02, 0.06), rng.uniform(0.02, 0.06)
    lines = ['title = "random"', 'levitated_at = ["amb_A", "amb_B"]', "[material.steel]"]
    lines += ['modulus = "207 GPa"', 'density = "7830 kg/m3"', "poisson = 0.3"]
    mass = 0.0
    for _ in range(elements):
        diameter = thickness * rng.uniform(0.8, 1.3)
        mass += 7830.0 * 0.25 * math.pi * diameter**2 * length
        lines += ["[[element]]", f'length = "{length} m"', f'outer_diameter = "{diameter} m"']
    for _ in range(int(rng.integers(1, 3))):
        outer, width = thickness * rng.uniform(2.5, 4.0), rng.uniform(0.01, 0.05)
        mass += 7830.0 * 0.25 * math.pi * (outer**2 - thickness**2) * width
        lines += ["[[disc]]", f"node = {rng.integers(3, elements)}", f'width = "{width} m"']
        lines += [f'outer_diameter = "{outer} m"', f'inner_diameter = "{thickness} m"']
    stations = ["[stations]", f"amb_A = {rng.integers(1, 4)}", f"amb_B = {elements - rng.integers(0, 3)}"]
    return "\n".join([*lines, *stations]), mass


def random_case(number: int) -> Case:
    """By a seed and a number; of some the loops are unstable."""
    rng = np.random.default_rng([SEED, number])
    flexible = bool(number % 2)
    gap, bias = rng.uniform(0.2e-3, 0.8e-3), rng.uniform(1.5, 4.0)
    alpha = rng.uniform(0.2, 0.5)
    mass, file = math.exp(rng.uniform(math.log(0.5), math.log(50.0))), ""
    if flexible:
        file, mass = shaft(rng)
    area = MU0 * rng.uniform(4.0, 12.0) * 9.81 * mass / 1.2**2
    mass *= 0.5 if flexible else 1.0
    turns = max(20.0, float(round(1.2 * 2.0 * gap / (MU0 * 2.0 * bias) * rng.uniform(0.7, 1.0))))
    amb: dict[str, float] = {"magnet.gap": gap, "magnet.area": area, "magnet.turns": turns}
    amb |= {"magnet.pole_angle": alpha, "amplifier.bias": bias, "amplifier.current_limit": 3.0 * bias}
    amb |= {"amplifier.bandwidth": rng.uniform(3e3, 3e4), "sensing.bandwidth": rng.uniform(5e3, 6e4)}
    amb |= {"magnet.flux_limit": 3.0, "sensing.gain": rng.uniform(0.8, 1.2)}
    amb["amplifier.reset"] = float(rng.choice([0.0, rng.uniform(100.0, 2000.0)]))
    amb["sample_time"] = period = float(rng.choice([5e-5, 1e-4, 2e-4])) * (0.5 if flexible else 1.0)
    rotor = {"speed": float(rng.choice([0.0, rng.uniform(50.0, 3000.0)]))}
    rotor |= {"modes": 6, "damping_ratio": rng.uniform(1e-3, 0.03)} if flexible else {"mass": mass}
    slope = MU0 * turns**2 * area * bias / gap**2 * math.cos(alpha)  # k_i
    negative = slope * bias / gap * math.cos(alpha)  # |k_s|
    left, damped = rng.uniform(0.2, 2.0), rng.uniform(0.2, 1.5)
    natural = math.sqrt(left * negative / mass)
    controller = {
        "gain.proportional": (1.0 + left) * negative / slope,
        "gain.filter": rng.uniform(1e3, 3e4),
    }
    controller["gain.derivative"] = 2.0 * damped * natural * mass / slope
    controller["gain.integral"] = float(rng.choice([0.0, 0.05])) * natural * left * negative / slope
    controller["delay"] = int(rng.integers(0, 2))
    for n in range(int(rng.integers(0, 3))):
        hz, zeros, poles = rng.uniform(200.0, 0.3 / period), rng.uniform(0.02, 0.5), rng.uniform(0.2, 0.9)
        for name, value in section(2.0 * math.pi * hz, zeros, poles, period).items():
            controller |= {f"channel[{k}].section[{n + 1}].{name}": value for k in (1, 2)}
    return Case(
        number,
        file,
        {"rotor": rotor, "amb": amb, "controller": controller},
        2 if flexible else 1,
    )


def section(w: float, zeros: float, poles: float, period: float) -> dict[str, float]:
    """A notch by Tustin's rule."""
    (b, a, _) = cont2discrete(
        ([1.0, 2 * zeros * w, w * w], [1.0, 2 * poles * w, w * w]), period, "bilinear"
    )
    return dict(zip(("b0", "b1", "b2", "a1", "a2"), map(float, (*b[0], *a[1:])), strict=True))


class Other:
    """The other model of a case; hold (A) by axis, since the project's static load is what it carries."""

    def __init__(self, case: Case, loops: Sampled, loads: list[float]) -> None:
        self.amb, self.gains = case.settings["amb"], case.settings["controller"]
        self.period, self.speed = self.amb["sample_time"], loops.speed
        rotor = loops.rotor
        n, m = len(rotor.omega), 2 * case.magnets
        along = math.sqrt(0.5) * np.array([[1.0, 1.0], [-1.0, 1.0]])  # magnets at 45 deg
        self.acts = np.array([np.kron(along[k % 2], rotor.acts[k // 2]) for k in range(m)])
        stiffness = np.kron(np.eye(2), np.diag(rotor.omega**2))
        damping = np.kron(np.eye(2), np.diag(2 * rotor.damping_ratio * rotor.omega))
        whirl = np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), self.speed * rotor.gyroscopic)
        reset, w_a, w_s = (
            self.amb[name] for name in ("amplifier.reset", "amplifier.bandwidth", "sensing.bandwidth")
        )
        per = 2 + (1 if reset else 0)  # of each axis: signal, force that follows, perhaps its integral
        size = 4 * n + per * m
        a, b, c = np.zeros((size, size)), np.zeros((size, m)), np.zeros((m, size))
        a[: 2 * n, 2 * n : 4 * n] = np.eye(2 * n)
        a[2 * n : 4 * n, : 2 * n] = -stiffness
        a[2 * n : 4 * n, 2 * n : 4 * n] = -damping - whirl
        for k in range(m):
            k_i, k_s = self.slopes(loads[k])
            s, f = 4 * n + per * k, 4 * n + per * k + 1
            a[s, s], a[s, : 2 * n], c[k, s] = -w_s, w_s * self.acts[k], self.amb["sensing.gain"]
            # both coils' currents follow at one rate: F' = w_a (k_i i_c - k_s u - F + w_r k_i integral)
            a[f, f], b[f, k] = -w_a, w_a * k_i
            a[f, : 2 * n] = -w_a * k_s * self.acts[k]
            if reset:
                a[f, f + 1] = w_a * reset
                a[f + 1, f], a[f + 1, : 2 * n], b[f + 1, k] = -1.0, -k_s * self.acts[k], k_i
            a[2 * n : 4 * n, f] = self.acts[k]
        self.plant = cont2discrete((a, b, c, np.zeros((m, m))), self.period)[:3]
        self.m = m

    def slopes(self, load: float) -> tuple[float, float]:
        """k_i and k_s where a load is held, by complex steps of K (i/g)^2 of two coils."""
        gap, bias, alpha = self.amb["magnet.gap"], self.amb["amplifier.bias"], self.amb["magnet.pole_angle"]
        k = MU0 * self.amb["magnet.turns"] ** 2 * self.amb["magnet.area"] / 4.0

        def pull(i: complex, u: complex) -> complex:
            plus, minus = (bias + i) / (gap - u * math.cos(alpha)), (bias - i) / (gap + u * math.cos(alpha))
            return k * math.cos(alpha) * (plus**2 - minus**2)

        hold = load / (4.0 * k * bias / gap**2 * math.cos(alpha))
        assert abs(hold) < bias  # else one coil is empty
        return pull(hold + 1e-30j, 0.0).imag / 1e-30, -pull(hold, 1e-30j).imag / 1e-30

    def law(self) -> tuple[np.ndarray, np.ndarray]:
        """Numerator and denominator of C(z) in powers of 1/z, with its delay and that of the actuator."""
        g, t = self.gains, self.period
        p, i, d, n = (g[f"gain.{name}"] for name in ("proportional", "integral", "derivative", "filter"))
        integral, lag = np.array([1.0, -1.0]), np.array([1.0 + n * t, -1.0])
        den = np.convolve(integral, lag) if i else lag
        num = p * den + d * n * (np.convolve([1.0, -1.0], integral) if i else np.array([1.0, -1.0]))
        if i:
            num = num + i * t * np.append(lag, 0.0)
        for k in (1, 2):
            if f"channel[1].section[{k}].b0" in g:
                b0, b1, b2, a1, a2 = (
                    g[f"channel[1].section[{k}].{x}"] for x in ("b0", "b1", "b2", "a1", "a2")
                )
                num, den = np.convolve(num, [b0, b1, b2]), np.convolve(den, [1.0, a1, a2])
        return np.append(np.zeros(1 + int(g["delay"])), num), den

    def poles(self) -> np.ndarray:
        """Eigenvalues of the closed loop from sample to sample."""
        num, den = self.law()
        size = max(len(num), len(den)) - 1
        num, den = (np.append(x, np.zeros(size + 1 - len(x))) / self.law()[1][0] for x in (num, den))
        ac, bc, cc = np.eye(size, k=-1), np.eye(size)[:, :1], num[None, 1:]  # num[0] is 0: it answers late
        ac[0] = -den[1:]
        eye = np.eye(self.m)
        ac, bc, cc = np.kron(eye, ac), np.kron(eye, bc), np.kron(eye, cc)
        a, b, c = self.plant
        return np.linalg.eigvals(np.block([[a, b @ cc], [-bc @ c, ac]]))

    def sensitivity(self, omega: np.ndarray) -> np.ndarray:
        """Of each axis (n, axes)."""
        num, den = self.law()
        back = np.exp(-1j * omega * self.period)
        law = np.polyval(num[::-1], back) / np.polyval(den[::-1], back)
        a, b, c = self.plant
        z = np.exp(1j * omega * self.period)
        parts = np.array([c @ np.linalg.solve(one * np.eye(len(a)) - a, b) for one in z])
        return np.diagonal(np.linalg.inv(np.eye(self.m) + law[:, None, None] * parts), axis1=1, axis2=2)

    def lines(self, poles: np.ndarray) -> np.ndarray:
        """A dense grid, denser around poles (of z)."""
        top = 0.99 * math.pi / self.period
        rates = np.log(poles[np.abs(poles) > 1e-6].astype(complex)) / self.period
        grids = [np.geomspace(2.0 * math.pi, top, COARSE)]
        away = np.geomspace(1e-3, 30.0, AROUND // 2)
        for rate in rates[(rates.imag > 6.0) & (np.abs(rates.real) < 0.1 * np.abs(rates.imag))]:
            grids.append(rate.imag + abs(rate.real) * np.concatenate((-away, [0.0], away)))
        every = np.unique(np.concatenate(grids))
        return every[(every >= 2.0 * math.pi) & (every <= top)]


def winding(loop: np.ndarray, omega: np.ndarray, delay: float) -> float:
    """Turns of 1 + L around 0 over the lines, L (n,) with a delay (s)."""
    around = 1.0 + loop * np.exp(-1j * omega * delay)
    steps = np.angle(around[1:] / around[:-1])
    return float(np.sum(steps) / (2.0 * math.pi))


def peak_of(other: Other, omega: np.ndarray, size: np.ndarray, axis: int) -> float:
    """The largest |S| of an axis, between lines by a parabola through three."""
    best = float(size.max())
    for k in np.argsort(size)[-5:]:
        if 0 < k < len(size) - 1:
            for _ in range(2):
                fine = np.linspace(omega[k - 1], omega[k + 1], 41)
                best = max(best, float(np.abs(other.sensitivity(fine)[:, axis]).max()))
    return best


def judged(case: Case, folder: Path) -> Iterator[tuple[str, float]]:
    """What is wrong with a case, and by how much; "peak" is the largest deviation of any."""
    scene = case.scene(folder)
    found = loops_in(scene, [])
    loops, own = found.loops, found.own
    assert isinstance(loops, Sampled)
    loads = [axis.load for bearing in loops.bearings for axis in bearing.axes]
    other = Other(case, loops, loads)
    poles = other.poles()
    largest = float(np.abs(poles).max())
    if abs(largest - 1.0) < NARROW:
        yield "marginal", largest
        return
    stable = largest < 1.0
    if stable != (own.unstable is None):
        yield "wrong stability", largest
        return
    yield ("stable" if stable else "unstable"), largest
    if not stable:
        return
    omega = other.lines(poles)
    values = other.sensitivity(omega)
    for axis, mine in enumerate(own.margins):
        exact = peak_of(other, omega, np.abs(values[:, axis]), axis)
        yield "peak", mine.peak / exact - 1.0
        if all(abs(exact - limit) > BORDER * limit for limit, _ in ZONES) and zone(exact) != mine.zone:
            yield "wrong zone", exact
        loop = 1.0 / values[:, axis] - 1.0
        if math.isfinite(mine.delay):
            crossing = np.array(mine.crossings)
            near = [w * (1.0 + BIT * np.linspace(-20.0, 20.0, 401)) for w in crossing]
            more = np.unique(np.concatenate([omega, *near]))
            more = more[more <= omega[-1]]
            loop = 1.0 / other.sensitivity(more)[:, axis] - 1.0
            kept, lost = (
                winding(loop, more, d) for d in (mine.delay * (1.0 - BIT), mine.delay * (1.0 + BIT))
            )
            now = winding(loop, more, 0.0)
            if round(kept - now, 0) != 0.0 or round(lost - now, 0) == 0.0:
                yield "wrong delay margin", mine.delay
        elif np.any(np.abs(loop) > 1.0):
            yield "wrong delay margin", math.inf


def main() -> None:
    """Print what is found, cases that are wrong one by one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    options = parser.parse_args()
    counts: dict[str, int] = {}
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(options.first, options.first + options.count):
            for what, size in judged(random_case(number), Path(folder)):
                counts[what] = counts.get(what, 0) + 1
                if what == "peak":
                    worst = max(worst, abs(size))
                if what.startswith("wrong") or what == "marginal" or (what == "peak" and abs(size) > 1e-5):
                    print(f"case {number}: {what} {size:.9g}", flush=True)
    print(f"{options.count} cases: " + ", ".join(f"{n} {what}" for what, n in sorted(counts.items())))
    print(f"largest deviation of a peak: {worst:.2g}")


if __name__ == "__main__":
    main()
