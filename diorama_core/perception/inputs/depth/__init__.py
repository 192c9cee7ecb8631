"""Measured depth: its containers, what its numbers mean, and its size."""
