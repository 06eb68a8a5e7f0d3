"""FMU: landing sleeve, a bore with faces."""

from touchdown.bearings.landing_sleeve import MODEL
from touchdown.fmus.slave import ModelSlave


class LandingSleeve(ModelSlave):
    """landing sleeve, a bore with faces."""

    model = MODEL
