"""Ray-cast pictures of scenes and shapes."""
