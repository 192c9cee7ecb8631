"""Nine-degree-of-freedom poses of shapes."""
