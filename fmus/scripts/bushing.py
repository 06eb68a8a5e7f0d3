"""FMU: plain touchdown bushing."""

from bearings.bushing import MODEL
from fmus.slave import ModelSlave


class Bushing(ModelSlave):
    """plain touchdown bushing."""

    model = MODEL
