"""FMU: active magnetic bearing with shutdown."""

from bearings.amb import MODEL
from fmus.slave import ModelSlave


class MagneticBearing(ModelSlave):
    """active magnetic bearing with shutdown."""

    model = MODEL
