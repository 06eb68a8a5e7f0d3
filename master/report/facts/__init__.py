"""What chapters ask of a run, and how its numbers are shown."""
