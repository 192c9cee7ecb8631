"""Poses from patch correspondences between the picture and rendered views, as the paper and its baselines find them."""
