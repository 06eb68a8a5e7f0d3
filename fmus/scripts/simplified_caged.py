"""FMU: simplified touchdown bearing with a cage."""

from fmus.slave import ModelSlave
from bearings.simplified_caged import MODEL


class SimplifiedCaged(ModelSlave):
    """simplified touchdown bearing with a cage."""

    model = MODEL
