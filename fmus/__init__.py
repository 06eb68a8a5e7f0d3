"""Models as FMI 2.0 co-simulation FMUs: one generic slave, one script of a few lines per FMU."""
