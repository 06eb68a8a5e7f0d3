"""What bearings sit in: a housing, a mount, or a foundation that several share."""
