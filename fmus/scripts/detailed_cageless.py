"""FMU: detailed touchdown bearing without a cage."""

from bearings.detailed_cageless import MODEL
from fmus.slave import ModelSlave


class DetailedCageless(ModelSlave):
    """detailed touchdown bearing without a cage."""

    model = MODEL
