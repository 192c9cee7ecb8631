"""Anyone's own models become shapes: files are read with care, put upright, measured, and handed to a store."""
