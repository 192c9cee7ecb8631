"""What people and programs upload to begin a project, decoded in a process of its own with limited memory."""

from __future__ import annotations

from dataclasses import dataclass, replace

from diorama_core.io.limited import LimitedProcess
from diorama_core.perception.inputs import ReadInputs, read_inputs
from diorama_core.perception.inputs.depth.kinds import DepthKind
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer
from diorama_core.perception.inputs.source import Source
from diorama_core.pipeline import codec


@dataclass(frozen=True)
class Upload:
    """What `read_inputs` takes, as it was uploaded."""

    photo: bytes
    name: str
    depth: bytes | Source | None = None
    boxes: bytes | Source | None = None
    masks: bytes | Source | None = None
    intrinsics: tuple[float, float, float, float] | None = None
    fov_deg: float | None = None
    depth_scale: float | None = None
    """Units of depth per metre; None where the file and the picture say."""
    depth_kind: DepthKind = "auto"
    half_turn: bool = False
    """Whether everything is upside down in its file."""
    sphere: bool = False
    """Whether the photo is to be a 360 degree photo."""
    bend: float | None = None
    """The photo's distortion as `Photo.straightened` has it, 0 to leave it; None where its lines are to say."""

    def answer(self, answer: DepthAnswer) -> Upload:
        """The upload with what a person says of its depth."""
        return replace(self, depth_scale=answer.per_metre, depth_kind=answer.kind)


def decode(upload: Upload, process: LimitedProcess) -> ReadInputs:
    """The checked inputs of an upload, decoded in a process.

    Raises:
        AmbiguousDepthError: the depth may be several things.
        InputError: a file cannot be read, or needs more memory or time than a file of its kind should.
    """
    answer = process.call(upload.name, read_packed, upload)
    if isinstance(answer, DepthQuestion):
        raise AmbiguousDepthError(answer.message, answer.choices)
    packed, warnings = answer
    return ReadInputs(codec.load(packed), warnings)


@dataclass(frozen=True)
class DepthQuestion:
    """What the decoding process cannot decide: errors come back from there as words alone."""

    message: str
    choices: tuple[DepthAnswer, ...]


def read_packed(upload: Upload) -> tuple[bytes, tuple[str, ...]] | DepthQuestion:
    """Checked inputs, packed, and warnings, or a question. Runs in the decoding process."""
    try:
        read = _read(upload)
    except AmbiguousDepthError as error:
        return DepthQuestion(str(error), error.choices)
    return codec.dump(read.inputs), read.warnings


def _read(upload: Upload) -> ReadInputs:
    from diorama_core.multiview.plumb_lines import undistort_by_lines  # in the decoding process only

    read = read_inputs(
        upload.photo,
        name=upload.name,
        depth=upload.depth,
        depth_scale=upload.depth_scale,
        depth_kind=upload.depth_kind,
        boxes=upload.boxes,
        masks=upload.masks,
        intrinsics=upload.intrinsics,
        fov_deg=upload.fov_deg,
        half_turn=upload.half_turn,
        sphere=upload.sphere,
    )
    if upload.sphere:
        return read
    inputs, notes = undistort_by_lines(read.inputs, upload.bend)
    return ReadInputs(inputs, read.warnings if upload.bend is not None else (*notes, *read.warnings))
