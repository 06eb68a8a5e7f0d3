"""The presentation of an FMU in other tools: its documentation and its icon."""
