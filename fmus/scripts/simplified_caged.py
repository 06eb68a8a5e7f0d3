"""FMU: simplified touchdown bearing with a cage."""

from bearings.simplified_caged import MODEL
from fmus.slave import ModelSlave


class SimplifiedCaged(ModelSlave):
    """simplified touchdown bearing with a cage."""

    model = MODEL
