"""Results beside the tables and figures of the source."""
