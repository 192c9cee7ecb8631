"""Floor, walls and ceiling as bounded planes."""
