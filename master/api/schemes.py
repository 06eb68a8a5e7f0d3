"""Coupling schemes of one's own."""

from __future__ import annotations

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.coupling import steppers
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.scene import schemes
from touchdown.master.scene.schemes import Scheme


def register_scheme(scheme: Scheme, stepper: type[Stepper] | None = None) -> None:
    """Let scenes, sweeps and comparisons name a coupling scheme of your own.

    With a `stepper`, a subclass of Stepper or of one of the project's, the scheme's `sequence` is the name
    it gets; without, `sequence` names one there is. Raises TouchdownError where the name of the scheme or
    of the new sequence is another's, where there is no such sequence, or a value cannot be; registering
    the same again is no mistake. Processes that a sweep starts know it too, where they can import the
    stepper: from a script or a module, not from a notebook.

    >>> mean_and_slope = touchdown.Scheme(
    ...     name="velocity-slope", title="velocity extrapolated, mean and slope",
    ...     order=1, slopes=True, modes=False, error_order=2, bears=0.08,
    ... )
    >>> touchdown.register_scheme(mean_and_slope)
    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene = scene.set({"run.duration": "8 ms", "run.scheme": "velocity-slope"})
    >>> touchdown.run(scene, in_process=True).summary["scheme"]
    'velocity-slope'
    """
    known = steppers.SEQUENCES
    if stepper is None and scheme.sequence not in known:
        raise TouchdownError(
            f"scheme {scheme.name}: there is no sequence {scheme.sequence}; "
            f"{one_of(scheme.sequence, known)}, or give a stepper"
        )
    if stepper is not None:
        steppers.check(scheme.sequence, stepper)
    schemes.register(scheme)
    if stepper is not None:
        steppers.register(scheme.sequence, stepper)
