"""The chapters of a report on a run: each a function of a `Subject` that returns blocks, or raises Absent."""
