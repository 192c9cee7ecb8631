"""CAD shapes: what exists, what it is called, how big it is, where things can stand on it."""
