"""Projects as folders: listing, the bundled example, reports."""
