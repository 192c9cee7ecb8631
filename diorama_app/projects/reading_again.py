"""The photo of a project read once more, with further files of it or in another way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from diorama_app.projects.begin import depth_answer
from diorama_app.projects.pictures import encode_picture
from diorama_app.projects.uploads import Upload
from diorama_core.artefacts import Inputs
from diorama_core.editing.input_corrections import boxes_json
from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.scale import DepthAnswer
from diorama_core.perception.inputs.sorting import Sort
from diorama_core.perception.inputs.source import Source
from diorama_core.project.storage import Project


def upload_again(
    project: Project,
    before: Inputs,
    new: Mapping[Sort, Source],
    answer: DepthAnswer | None,
    intrinsics: tuple[float, float, float, float] | None,
    *,
    turn: bool = False,
    bend: bool = False,
) -> Upload:
    """What is to be read: the project's files, and new ones in their place.

    Args:
        project: with what was given before.
        before: as they were read last, with the boxes as they were corrected.
        new: files by their sort, as `with_depth` has them.
        answer: what a person says of new depth.
        intrinsics: of the camera, pixels of the photo's file.
        turn: turn everything by 180 degrees.
        bend: leave out the straightening of the photo.
    """
    given, photo = project.uploads(), before.photo
    if "photo" not in given:
        photo = replace(photo, straightened=None)  # the file that bends is not here
    known = "depth" not in new or new["depth"].data == given.get("depth")
    reading = answer or (depth_answer(project) if known else DepthAnswer(""))
    return Upload(
        given.get("photo") or encode_picture(photo.rgb[::-1, ::-1] if photo.half_turned else photo.rgb, "PNG"),
        photo.name,
        depth=new.get("depth") or _depth(project),
        boxes=new.get("boxes") or (boxes_json(before.boxes, photo) if before.boxes else None),
        masks=new.get("masks", given.get("masks")),
        depth_scale=reading.per_metre,
        depth_kind=reading.kind,
        intrinsics=intrinsics,
        half_turn=bool(photo.half_turned) != turn,
        bend=0.0 if bend else photo.straightened or 0.0,
    )


def with_depth(new: Mapping[Sort, Source], project: Project | None) -> dict[Sort, Source]:
    """New files, of which the confidence of a depth map is beside that map, which may be the project's.

    Raises:
        InputError: there is confidence, but no depth.
    """
    fields = dict(new)
    confidence = fields.pop("confidence", None)
    if confidence is None:
        return fields
    depth = fields.get("depth") or (None if project is None else _depth(project))
    if depth is None:
        raise InputError(f"{confidence.name}: this is the confidence of a depth map; add the depth map, too")
    return {**fields, "depth": replace(depth, companions=(confidence,))}


def _depth(project: Project) -> Source | None:
    given = project.uploads()
    if "depth" not in given:
        return None
    beside = (Source(given["confidence"], "its confidence"),) if "confidence" in given else ()
    return Source(given["depth"], "depth", companions=beside)
