"""What `touchdown` offers to Python: entry functions, each a few lines over the room that does the work."""
