"""Training of the small networks that come with Diorama, on pictures of made rooms.

`python -m diorama_core.training pictures | train | export | score`, one command each; seeded, and resumed where they
stopped. `assets/models/README.md` tells how the shipped weights were made and how good they are.
"""
