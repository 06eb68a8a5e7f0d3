"""FMU: controller of magnetic bearings."""

from touchdown.bearings.magnetic.amb_controller import MODEL
from touchdown.fmus.slave import ModelSlave


class MagneticController(ModelSlave):
    """controller of magnetic bearings."""

    model = MODEL
