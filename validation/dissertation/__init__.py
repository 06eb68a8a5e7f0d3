"""Figures and tables of the dissertation that the models follow, beside its values."""
