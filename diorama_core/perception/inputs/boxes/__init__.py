"""Boxes around things, in the forms that annotation tools and detectors write."""
