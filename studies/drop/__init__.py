"""One drop in detail: its first impact, a monolithic reference, measured ones."""
