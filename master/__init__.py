"""The master: scenes, coupling, recording, results. It knows no physics."""
