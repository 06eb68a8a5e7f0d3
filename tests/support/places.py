"""Where things are, and how the command is run in a process of its own."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = (
    *("modelkit", "rotor", "bearings", "fmus", "master"),
    *("studies", "reports", "command", "validation"),
)
SUPPORT = ROOT / "tests" / "support"
COMMAND = (sys.executable, "-m", "touchdown")
