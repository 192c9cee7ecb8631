"""Outlines of things: pictures of colours or numbers, folders of masks, arrays and run lengths."""
