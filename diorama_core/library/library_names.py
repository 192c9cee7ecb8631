"""How libraries are named where several are joined; apart from `store`, which loads meshes."""

BUILT_IN = "built-in"
ESCAPED_PLUS = "%2B"
"""Stands for a + in the path of a library, where names are joined by +."""
