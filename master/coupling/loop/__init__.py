"""What takes macro steps: one by one, or many of them in compiled code, and who takes no more."""
