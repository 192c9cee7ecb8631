"""The numbers of the room that is read from measured depth."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class WallSettings:
    """How walls, their order and their openings are found."""

    beside_camera_m: float = 0.5
    """The floor reaches at least this far to either side of the camera."""
    highest_room_m: float = 9.0
    seen_confidence: float = 0.9
    cell_m: float = 0.06
    beyond_m: float = 0.25
    """What is seen less far behind a wall is a niche, a frame or noise."""
    min_area_m2: float = 0.35
    min_side_m: float = 0.35
    min_fill: float = 0.75
    """Share of its rectangle that an opening fills."""
    seen_through: float = 0.6
    """Share of a cell's rays that must pass."""
    frame_m: float = 0.10
    """Openings this near an end or the top of the wall are its end, not an opening."""
    sill_m: float = 0.3
    """Openings that come down lower than this are doorways and reach the floor."""
    max_misfit_px: float = 0.03
    """A rectangle whose outline misses the box by more, as a share of the photo's longer side, is not in that wall."""
    grid_px: int = 320
    flatness: float = 0.004
    """Relative deviation from a plane, besides noise, up to which a window counts as flat."""
    min_share: float = 0.5
    """Share of a window that must be measured."""
    alike_share: float = 0.1
    """Neighbouring samples whose depths differ by less than this share are averaged when the map is reduced."""
    collinear_m: float = 0.1
    alike_m: float = 0.1
    alike_per_m: float = 0.03
    """Neighbours turned by less than that and apart by less than this, plus this per metre of distance, are one
    wall."""
    max_hidden_m: float = 3.0
    behind_camera_m: float = 0.4
    """Side walls end this far behind the camera."""
    beyond_view_m: float = 0.3
    max_range_m: float = 12.0
    usual_ceiling_m: float = 2.6
    min_flat_share: float = 0.004
    """Minimum share of the measured points on the floor for it to count as visible."""


SETTINGS = WallSettings()
