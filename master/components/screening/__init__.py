"""What is looked at before an FMU is loaded: its description, and its library."""
