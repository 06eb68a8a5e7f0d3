"""Section 4.3: a disk on four models of bearings."""
