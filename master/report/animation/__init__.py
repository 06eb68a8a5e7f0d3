"""Moving pictures of a drop: `motion` is what moves, `film` draws it into a file; a page has a script."""
