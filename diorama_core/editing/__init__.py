"""Editing a scene without a server: placing, dragging, stretching, aligning, clipboard, collisions, corrections."""
