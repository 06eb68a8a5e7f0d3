"""FMU: housing on springs and dampers."""

from bearings.housing import MODEL
from fmus.slave import ModelSlave


class Housing(ModelSlave):
    """housing on springs and dampers."""

    model = MODEL
