"""Poses that respect support, contact and space."""
