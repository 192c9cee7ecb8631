"""The room from one photo without depth."""
