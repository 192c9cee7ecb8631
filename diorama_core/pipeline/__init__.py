"""The stages' explicit construction, and the runner that caches, reports and resumes."""
