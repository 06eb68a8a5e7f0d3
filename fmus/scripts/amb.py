"""FMU: active magnetic bearing with shutdown."""

from fmus.slave import ModelSlave
from bearings.amb import MODEL


class MagneticBearing(ModelSlave):
    """active magnetic bearing with shutdown."""

    model = MODEL
