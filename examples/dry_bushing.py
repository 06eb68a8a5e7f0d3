"""A touchdown bearing of your own: a plain bushing with dry friction, in SI units."""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

SHAFT = ("x", "y", "vx", "vy", "ax", "ay", "inv_m", "omega")
INPUTS = [*(f"shaft_{name}" for name in SHAFT), "house_x", "house_y"]
OUTPUTS = ["shaft_fx", "shaft_fy", "shaft_mz", "house_fx", "house_fy"]
PARAMETERS = {"clearance": 0.2e-3, "radius": 0.01, "stiffness": 2e7, "damping": 2e3, "friction": 0.1}


class DryBushing(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for kind, names in (("input", INPUTS), ("output", OUTPUTS), ("parameter", PARAMETERS)):
            for name in names:
                setattr(self, name, PARAMETERS.get(name, 0.0))
                held = Fmi2Variability.fixed if kind == "parameter" else Fmi2Variability.continuous
                self.register_variable(Real(name, causality=Fmi2Causality[kind], variability=held))

    def do_step(self, current_time, step_size):  # the shaft is carried as a point mass, in 20 steps
        x, vx, y, vy = self.shaft_x, self.shaft_vx, self.shaft_y, self.shaft_vy
        h, mean = step_size / 20, [0.0, 0.0, 0.0]
        for _ in range(20):
            dx, dy = x - self.house_x, y - self.house_y
            r = math.hypot(dx, dy) or 1e-12
            nx, ny, depth = dx / r, dy / r, r - self.clearance
            push = max(0.0, self.stiffness * depth + self.damping * (vx * nx + vy * ny)) * (depth > 0)
            slip = vy * nx - vx * ny + self.radius * self.shaft_omega
            rub = -self.friction * push * math.tanh(100 * slip)
            load = -push * nx - rub * ny, -push * ny + rub * nx, self.radius * rub
            mean = [before + now / 20 for before, now in zip(mean, load, strict=True)]
            vx += h * (self.shaft_ax + self.shaft_inv_m * load[0])
            vy += h * (self.shaft_ay + self.shaft_inv_m * load[1])
            x, y = x + h * vx, y + h * vy
        self.shaft_fx, self.shaft_fy, self.shaft_mz = mean
        self.house_fx, self.house_fy = -mean[0], -mean[1]
        return True
