"""Asking a large multimodal model: what is there, what holds up what. Any OpenAI-compatible endpoint."""
