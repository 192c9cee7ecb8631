"""Walls, ceilings and openings, from measured points or from a photo, closed to a room."""
