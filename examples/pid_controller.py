"""A controller of magnetic bearings of your own, which knows nothing of this project, in SI units."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class PidController(Fmi2Slave):
    """Two axes, stepped once per sample."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.pos_a = self.pos_b = self.hold_a = self.hold_b = 0.0  # m, A
        self.cur_a = self.cur_b = 0.0  # A
        self.k_p, self.k_i, self.k_d, self.cut_off, self.most = 9.7e3, 4e4, 15.5, 6000.0, 4.0
        for name in ("pos_a", "pos_b", "hold_a", "hold_b"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in ("cur_a", "cur_b"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        for name in ("k_p", "k_i", "k_d", "cut_off", "most"):
            self.register_variable(Real(name, **fixed))
        self.memory = None  # by axis: integral, derivative, last measurement

    def do_step(self, current_time, step_size):
        if self.memory is None:
            self.memory = [[self.hold_a, 0.0, 0.0], [self.hold_b, 0.0, 0.0]]
        self.cur_a = self.answer(self.memory[0], -self.pos_a, step_size)
        self.cur_b = self.answer(self.memory[1], -self.pos_b, step_size)
        return True

    def answer(self, memory, error, period):
        slope = self.k_d * self.cut_off * (error - memory[2])
        memory[1] = (memory[1] + slope) / (1.0 + self.cut_off * period)
        memory[2] = error
        step = self.k_i * period * error
        current = self.k_p * error + memory[0] + memory[1]
        if abs(current + step) <= self.most or (current + step) * step < 0.0:
            memory[0] += step
            current += step
        return min(max(current, -self.most), self.most)
