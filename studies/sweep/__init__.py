"""One scene at many values of its settings."""
