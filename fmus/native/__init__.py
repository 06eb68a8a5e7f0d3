"""FMUs that need no Python: a model's kernels, compiled and linked with an FMI 2.0 side in C."""
