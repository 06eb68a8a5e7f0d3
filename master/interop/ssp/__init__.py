"""Systems as SSP 1.0 packages (System Structure and Parameterization), written and read."""
