"""How a journal moves on: its spectra, whether its motion grows, and when it has settled."""
