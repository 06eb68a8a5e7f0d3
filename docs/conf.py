"""Sphinx's settings; `python docs/pages.py` runs it."""

from typing import Any

from touchdown.command.options import MEANING
from touchdown.fmus.version import VERSION

project = "touchdown-cosim"
author = "touchdown-cosim developers"
version = release = VERSION
extensions = ["myst_nb", "sphinx.ext.autodoc"]
source_suffix = {".md": "myst-nb"}  # those that begin as notebooks are executed, the others are plain pages
html_theme = "furo"
html_title = f"touchdown-cosim {VERSION}"
default_role = "code"  # `name` in a docstring
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_execution_timeout = 600  # s per cell: where nothing is compiled yet
nb_merge_streams = True
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
smartquotes = False


def setup(app: Any) -> None:
    """Have defaults that print as `<factory>` shown as `...`, and parameters of functions as fields."""

    def readable(app: Any, what: str, name: str, value: Any, options: Any, arguments: str, returned: str):
        return (arguments or "").replace("<factory>", "...") or None, returned

    def fields(app: Any, what: str, name: str, value: Any, options: Any, lines: list[str]):
        if what == "function":
            lines[:] = MEANING.sub(r":param \1: \2", "\n".join(lines)).split("\n")

    app.connect("autodoc-process-signature", readable)
    app.connect("autodoc-process-docstring", fields)
