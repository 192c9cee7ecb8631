"""The room from measured depth."""
