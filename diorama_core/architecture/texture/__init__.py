"""Textures of the planes."""
