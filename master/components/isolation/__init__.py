"""FMUs in separate processes: the master survives a crash or hang there and reports it."""
