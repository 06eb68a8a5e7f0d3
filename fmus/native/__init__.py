"""FMUs that need no Python: a model's kernels, compiled and linked with an FMI side in C."""
