"""Which shapes of the library could each object be."""
