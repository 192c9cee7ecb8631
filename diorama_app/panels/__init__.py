"""The editor's panels, one module each."""
