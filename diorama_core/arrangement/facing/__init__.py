"""Which way the objects of a room face: all of them in one inference.

`evidence` is what is known of every object, `terms` what speaks for headings, with fitted weights; `solve` decides.
"""
