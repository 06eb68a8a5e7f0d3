"""What `touchdown` offers to Python: entry functions, each a few lines over what does the work."""
