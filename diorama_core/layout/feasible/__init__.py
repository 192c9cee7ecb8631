"""The default recipe: exact structure, then the least move."""
