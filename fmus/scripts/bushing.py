"""FMU: plain touchdown bushing."""

from touchdown.bearings.bushing import MODEL
from touchdown.fmus.slave import ModelSlave


class Bushing(ModelSlave):
    """plain touchdown bushing."""

    model = MODEL
