"""Results of a run: the recording, its summary, spectra, whirl and stresses, and their figures."""
