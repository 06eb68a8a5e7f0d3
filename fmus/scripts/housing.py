"""FMU: housing on springs and dampers."""

from touchdown.bearings.supports.housing import MODEL
from touchdown.fmus.slave import ModelSlave


class Housing(ModelSlave):
    """housing on springs and dampers."""

    model = MODEL
