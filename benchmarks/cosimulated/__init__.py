"""Parts of `benchmarks/masters.py`: problems, masters, the drivers of other tools, table and picture."""
