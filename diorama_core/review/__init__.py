"""What a person is asked about a scene that was built, the most helpful question first, and what answers change."""
