"""Camera, objects, depth and supports from the picture."""
