"""Reading within bounds, atomic writes, caches, GLB containers, sRGB, and decoding in a process of its own."""
