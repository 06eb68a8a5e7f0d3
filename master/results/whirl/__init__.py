"""Whether a journal whirls around its bearing, and what it does where it does not."""
