"""The Python side of an FMU by pythonfmu: sources that travel in it, and the interpreter it finds."""
