"""Mathematics that kernels need and no library has as they need it."""
