"""FMU: plain touchdown bushing."""

from fmus.slave import ModelSlave
from bearings.bushing import MODEL


class Bushing(ModelSlave):
    """plain touchdown bushing."""

    model = MODEL
