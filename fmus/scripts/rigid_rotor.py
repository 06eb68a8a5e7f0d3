"""FMU: rigid rotor."""

from fmus.slave import ModelSlave
from rotor.rigid import MODEL


class RigidRotor(ModelSlave):
    """rigid rotor."""

    model = MODEL
