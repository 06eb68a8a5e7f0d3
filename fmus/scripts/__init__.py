"""One script per FMU; a file here with a `ModelSlave` in it is an FMU of the project."""
