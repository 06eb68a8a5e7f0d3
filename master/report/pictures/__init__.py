"""Pictures that only a report has."""
