"""Where components come from, and how they are loaded and made ready."""
