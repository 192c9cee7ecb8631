"""Several photos of one room with known cameras.

posed_photos.py   reading cameras: COLMAP, nerfstudio, ARKit
alignment.py      gravity, axes, metres and floor for their world
joint_fit.py      one cuboid that fits its boxes in all photos
cut_short.py      which edges of boxes something nearer may hide
joining.py        which boxes of different photos are of one object
joint_room.py     walls and floor of all photos
room_pictures.py  floor, walls and ceiling as all photos show them
one_scene.py      objects and supports of each photo's scene in the room of all
rooms.py          from posed photos to one scene
better_seen.py    what an object is, by a photo that shows it better
rebuilding.py     a scene built anew, with the photos that had joined
"""
