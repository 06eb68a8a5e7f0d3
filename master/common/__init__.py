"""Modules that every subpackage of the master uses: errors, units, files, archives, processes."""
