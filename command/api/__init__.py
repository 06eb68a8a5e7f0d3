"""The Python interface: entry functions of a few lines each over the modules that do the work."""
