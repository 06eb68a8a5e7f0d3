"""Sphinx's settings; `python docs/pages.py` runs it."""

from touchdown.fmus.version import VERSION

project = "touchdown-cosim"
author = "touchdown-cosim developers"
version = release = VERSION
extensions = ["myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
html_theme = "furo"
html_title = f"touchdown-cosim {VERSION}"
default_role = "code"  # `name` in a docstring
myst_heading_anchors = 3
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
