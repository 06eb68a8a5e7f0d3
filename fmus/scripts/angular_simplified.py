"""FMU: simplified touchdown bearing with a cage."""

from touchdown.bearings.angular_simplified import MODEL
from touchdown.fmus.slave import ModelSlave


class SimplifiedCaged(ModelSlave):
    """simplified touchdown bearing with a cage."""

    model = MODEL
