"""FMU: detailed touchdown bearing with a cage."""

from bearings.detailed_caged import MODEL
from fmus.slave import ModelSlave


class DetailedCaged(ModelSlave):
    """detailed touchdown bearing with a cage."""

    model = MODEL
