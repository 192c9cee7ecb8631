"""Long jobs that read the photo: building, correcting, describing, fetching networks."""
