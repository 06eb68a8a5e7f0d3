"""modelDescription.xml, derived from a model's declarations."""
