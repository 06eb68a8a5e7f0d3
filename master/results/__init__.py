"""What a run leaves: the recording, its summary, spectra, whirl and stresses, and their figures."""
