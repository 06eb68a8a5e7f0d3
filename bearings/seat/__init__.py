"""How a bearing carries its journal and its housing through a macro step.

The bearing steps first, from the bodies' state at t_n. Within the step it integrates, beside its own
bodies, a copy of the journal and of the housing, each driven by the bearing's own load F(t):

    z'' = a_free + inv_m F(t) [- k/m (z - z_n) - c/m (z' - z'_n)]        omega' = alpha_free + inv_I M(t)

(the bracket for a housing on its springs, where it says so). A journal on a flexible rotor is the sum of
a point mass and of such oscillators, one for each of the rotor's elastic modes that it is told of.

With it run the quadratures of what crosses the interface: impulse, first moment in time, and work. The
load handed back is mean + slope (t - t_mid) with the same impulse and first moment, so a body that is a
point mass ends the step exactly where its copy did. For a housing on springs the two numbers are
chosen to give that, too (`modelkit.numerics.oscillator.load_for`); without springs that is the same impulse
and first moment again. For elastic modes, which may be faster than the macro step, what mean and slope
leave open is handed over beside them (`ModeLoad`).

At the next restart the copy takes the body's state; half the sum of the loads before and after times
that jump is the work the copy missed, and is accounted for as `jump`.

`copies` says where the copies of a planar bearing lie in its state and memory and how they move, `step`
what is made of the load and in which order, `space` what a bearing in space has beside that: the same along
the shaft, and the shaft's direction. Kernels take the bearing's whole state q and its derivative dq, both
(m.n,) or longer, and its memory, the record m; all in SI units.
"""

from __future__ import annotations

# ruff: noqa: F401 (the names that bearings use)
from .copies import (
    HE,
    HPX,
    HPY,
    HVX,
    HVY,
    HX,
    HY,
    INSIDE,
    JE,
    JPX,
    JPY,
    JVX,
    JVY,
    JW,
    JX,
    JY,
    MODES_SIZE,
    OWN,
    OWN_QUADRATURES,
    PARTS,
    POSITION_SCALE,
    SPIN_SCALE,
    VELOCITY_SCALE,
    BearingInputs,
    SeatMemory,
    bearing_memory,
    copy_rates,
    drift,
    forecast,
    housing_motion,
    journal_motion,
    last_load,
    set_weights,
    take_inputs,
)
from .step import PLANAR, advance, any_time, begin, instant, integrate
