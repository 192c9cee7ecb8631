"""Atomic files, files that can be made again, caches in memory, GLB containers and sRGB: one place for each."""
