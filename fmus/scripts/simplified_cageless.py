"""FMU: simplified touchdown bearing without a cage."""

from touchdown.bearings.simplified_cageless import MODEL
from touchdown.fmus.slave import ModelSlave


class SimplifiedCageless(ModelSlave):
    """simplified touchdown bearing without a cage."""

    model = MODEL
