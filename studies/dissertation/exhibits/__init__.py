"""Figures and tables of the source by name: each as a picture, and as rows beside the source's values."""
