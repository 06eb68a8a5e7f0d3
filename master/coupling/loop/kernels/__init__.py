"""Kernels of the loop: exchange, ledger and stretches of macro steps. They know no model, and no scene.

Components stand in tables, by their addresses, so each kernel is compiled once for all scenes.
"""

from __future__ import annotations

from .....modelkit.kernel import kernel_of

FOLDERS = "modelkit/kernel", "master/coupling/loop/kernels"

kernel = kernel_of(*FOLDERS)
kernel_without_gil = kernel_of(*FOLDERS, nogil=True)
