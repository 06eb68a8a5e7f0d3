"""FMU: simplified touchdown bearing without a cage."""

from fmus.slave import ModelSlave
from bearings.simplified_cageless import MODEL


class SimplifiedCageless(ModelSlave):
    """simplified touchdown bearing without a cage."""

    model = MODEL
