"""Several photos of one room with known cameras, and one 360 degree photo of a room.

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
sphere_frame.py   gravity and the room's axes by lines all round
sphere_room.py    the room by its borders all round
sphere_views.py   perspective views of a sphere, and its objects in all of them
sphere_scene.py   from one 360 degree photo to one scene
rebuilding.py     a scene built anew, with the photos that had joined
"""
