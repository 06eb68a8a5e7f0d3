"""Processes that the master starts: side by side, none outliving its parent, code of others watched."""
