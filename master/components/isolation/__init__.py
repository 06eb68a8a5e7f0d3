"""FMUs in processes of their own: whatever their code does there, the master goes on and names it."""
