"""A sweep as pictures over one or two of its settings."""
