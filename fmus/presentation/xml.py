"""XML as files of FMUs and packages have it."""

from __future__ import annotations

from xml.etree.ElementTree import Element, tostring


def document(root: Element) -> bytes:
    """A file with `root` in it, laid out as it is."""
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root) + b"\n"
