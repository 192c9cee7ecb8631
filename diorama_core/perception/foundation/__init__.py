"""Stages that run downloaded networks: what is in the photo, its outlines, its depth."""
