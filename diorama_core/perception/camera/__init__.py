"""Camera estimation: intrinsics, gravity and the room's axes."""
