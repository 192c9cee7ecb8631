"""How the camera is held: intrinsics, gravity and the room's axes."""
