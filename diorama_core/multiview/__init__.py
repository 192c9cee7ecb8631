"""Several photos of one room with known cameras, and one 360 degree photo of a room."""
