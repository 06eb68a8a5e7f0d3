"""What touches a ball beside: its neighbours in the row, or its pocket in the cage."""
