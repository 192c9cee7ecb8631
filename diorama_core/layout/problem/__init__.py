"""What the layout optimisers solve."""
