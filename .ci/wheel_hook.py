"""What a wheel of this project needs beside its files.

A wheel for a platform gets machine code and FMUs: `.ci/build_wheel.py` says which, and for what, by two
variables of the environment.
"""

from __future__ import annotations

import os
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SHIPPED, TAG = "TOUCHDOWN_SHIPPED", "TOUCHDOWN_WHEEL_TAG"


class WheelHook(BuildHookInterface):
    """Runs before every build of a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Take in what is to come along."""
        if version != "editable" and SHIPPED in os.environ:
            build_data["force_include"][os.environ[SHIPPED]] = "touchdown/shipped"
            build_data["pure_python"] = False
            build_data["tag"] = os.environ[TAG]
