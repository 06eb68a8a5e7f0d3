"""Components connected and stepped together: system, steppers, loop, ledger and recorder."""
