"""Stage protocols, their explicit construction, and the runner that caches, reports and resumes."""
