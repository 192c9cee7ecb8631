"""What the pointer does in the 3D view: dragging, resizing, selecting, placing."""
