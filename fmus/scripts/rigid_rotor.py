"""FMU: rigid rotor."""

from touchdown.fmus.slave import ModelSlave
from touchdown.rotor.rigid import MODEL


class RigidRotor(ModelSlave):
    """rigid rotor."""

    model = MODEL
