"""Support graphs from geometry, without a language model."""
