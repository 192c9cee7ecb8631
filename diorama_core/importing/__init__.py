"""Scenes from files: what Diorama wrote comes back as the same scene, other files become a scene of objects.

marked.py    what a file written by Diorama says: its scene document, and where each node is now
gltf.py      GLB and glTF       usd.py    USD and USDZ        sweethome.py    Sweet Home 3D
opening.py   the scene again, with what was moved, deleted, copied or hung elsewhere in the file
foreign.py   files of other programs
forms.py     the table of all forms: one door, which says what a file is before it reads it
"""
