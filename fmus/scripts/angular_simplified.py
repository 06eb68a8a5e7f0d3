"""FMU: simplified touchdown bearing in space."""

from touchdown.bearings.angular_simplified import MODEL
from touchdown.fmus.slave import ModelSlave


class AngularSimplified(ModelSlave):
    """simplified touchdown bearing in space."""

    model = MODEL
