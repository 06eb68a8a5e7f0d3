"""A report as a page: the blocks it is made of, its template, its script and style, its print."""
