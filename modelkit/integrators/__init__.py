"""Integrators compiled into the models that step with them, one method each, and what controls the step."""
