"""FMU: active magnetic bearing with shutdown."""

from touchdown.bearings.magnetic.amb import MODEL
from touchdown.fmus.slave import ModelSlave


class MagneticBearing(ModelSlave):
    """active magnetic bearing with shutdown."""

    model = MODEL
