"""Comparisons made of many runs, a folder each: what is compared, its report, its figure."""
