"""Decisions that concern all objects of a room together: which way each of them faces, and what holds each of them."""
