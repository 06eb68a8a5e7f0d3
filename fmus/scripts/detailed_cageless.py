"""FMU: detailed touchdown bearing without a cage."""

from touchdown.bearings.detailed_cageless import MODEL
from touchdown.fmus.slave import ModelSlave


class DetailedCageless(ModelSlave):
    """detailed touchdown bearing without a cage."""

    model = MODEL
