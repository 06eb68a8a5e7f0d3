"""FMU: detailed touchdown bearing with a cage."""

from touchdown.bearings.detailed_caged import MODEL
from touchdown.fmus.slave import ModelSlave


class DetailedCaged(ModelSlave):
    """detailed touchdown bearing with a cage."""

    model = MODEL
