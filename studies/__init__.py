"""Many runs, or none: sweeps, verdicts, comparisons, drops, machines, rotors, loops."""
