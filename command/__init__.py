"""The command `touchdown`, and the public names of Python."""
