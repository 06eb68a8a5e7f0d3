"""Systems that masters are compared on."""
