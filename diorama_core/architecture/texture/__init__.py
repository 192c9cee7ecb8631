"""The planes' own pictures."""
