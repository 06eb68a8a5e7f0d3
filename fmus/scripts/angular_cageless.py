"""FMU: detailed touchdown bearing without a cage, every ball a body in space."""

from touchdown.bearings.angular_cageless import MODEL
from touchdown.fmus.slave import ModelSlave


class AngularCageless(ModelSlave):
    """detailed touchdown bearing without a cage, in space."""

    model = MODEL
