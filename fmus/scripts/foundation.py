"""FMU: foundation under several touchdown bearings."""

from touchdown.bearings.supports.foundation import MODEL
from touchdown.fmus.slave import ModelSlave


class Foundation(ModelSlave):
    """foundation under several touchdown bearings."""

    model = MODEL
