"""What every room of the master may lean on: errors, units, files, archives, processes."""
