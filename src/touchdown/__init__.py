"""Rotor drops onto touchdown bearings, co-simulated with FMUs."""

from __future__ import annotations

import os

# In a wheel the packages lie in this folder. In a checkout they lie at its top: this file is
# TOP/src/touchdown/__init__.py there, and they are looked for in TOP first.
_top = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
if os.path.isfile(os.path.join(_top, "pyproject.toml")) and os.path.isdir(os.path.join(_top, "modelkit")):
    __path__.insert(0, _top)
