"""What an FMU by pythonfmu needs of Python: sources that travel in it, and the interpreter it finds."""
