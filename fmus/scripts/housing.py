"""FMU: housing on springs and dampers."""

from fmus.slave import ModelSlave
from bearings.housing import MODEL


class Housing(ModelSlave):
    """housing on springs and dampers."""

    model = MODEL
