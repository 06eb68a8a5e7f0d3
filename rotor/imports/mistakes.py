"""What is said where something cannot be imported."""

from touchdown.modelkit.model import ModelError


class ImportedRotorError(ModelError):
    """What cannot be taken over: file, place, value and remedy in one line."""
