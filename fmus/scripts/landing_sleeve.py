"""FMU: simplified touchdown bearing with a cage."""

from touchdown.bearings.landing_sleeve import MODEL
from touchdown.fmus.slave import ModelSlave


class SimplifiedCaged(ModelSlave):
    """simplified touchdown bearing with a cage."""

    model = MODEL
