"""A rotor before it is dropped: modes, whirl speeds and static deflection, as report and figure."""
