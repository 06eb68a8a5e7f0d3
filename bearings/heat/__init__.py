"""Heat of a bearing: where it arises, what it warms, and what warmth and spin do to its gaps."""
