"""FMU: simplified touchdown bearing without a cage."""

from bearings.simplified_cageless import MODEL
from fmus.slave import ModelSlave


class SimplifiedCageless(ModelSlave):
    """simplified touchdown bearing without a cage."""

    model = MODEL
