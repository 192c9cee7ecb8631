"""Several photos of one room with known cameras.

posed_photos.py   reading cameras: COLMAP, nerfstudio, ARKit
alignment.py      gravity, axes, metres and floor for their world
joint_fit.py      one cuboid that fits its boxes in all photos
joining.py        which boxes of different photos are of one object
rooms.py          from posed photos to one scene
"""
