"""Files and memory: atomic writes and caches."""
