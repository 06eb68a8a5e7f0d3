"""Reports: what a run found as a page that is handed on, and as moving pictures."""
