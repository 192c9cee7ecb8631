"""Decisions that concern all objects of a room together: which way each of them faces, what holds it, and why."""
