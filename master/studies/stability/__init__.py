"""For which macro steps the coupling of a contact to a body stays stable."""
