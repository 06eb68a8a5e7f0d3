"""FMU: detailed touchdown bearing with a cage, every ball a body in space."""

from touchdown.bearings.angular_caged import MODEL
from touchdown.fmus.slave import ModelSlave


class AngularCaged(ModelSlave):
    """detailed touchdown bearing with a cage, in space."""

    model = MODEL
