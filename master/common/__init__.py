"""Modules that every subpackage of the master uses: errors, units, files, processes."""
