"""What `touchdown` offers to Python: entry functions, each a few lines over the subpackage that does the work."""
