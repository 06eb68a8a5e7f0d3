"""What an FMU shows of itself in other tools: its documentation and its icon."""
