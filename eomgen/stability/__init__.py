"""Largest stable steps, modes and conditioning: what fixed steps of a scene can bear."""
