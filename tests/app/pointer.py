"""What a pointer in the 3D view sends: viser's own events, without a browser."""

from __future__ import annotations

from typing import Any, Literal

import viser

MIDDLE = (0.5, 0.5)
"""Of the view, as its share from the upper left corner; where the events do not say otherwise."""

Modifier = Literal["shift", "alt", "cmd/ctrl"]


def clicked(
    client: viser.ClientHandle, target: Any, *, at: tuple[float, float] = MIDDLE, modifier: Modifier | None = None
) -> viser.SceneNodePointerEvent:
    """A click on a node."""
    return viser.SceneNodePointerEvent(
        client=client,
        client_id=client.client_id,
        event="click",
        target=target,
        ray_origin=(0.0, 0.0, 0.0),
        ray_direction=(0.0, 1.0, 0.0),
        screen_pos=at,
        instance_index=None,
        modifier=modifier,
    )


def dragged(
    client: viser.ClientHandle,
    target: Any,
    phase: Literal["start", "update", "end"],
    grabbed: Any,
    hand: Any,
    *,
    modifier: Modifier | None = None,
) -> viser.SceneNodeDragEvent:
    """A node grabbed at a point (3,) of the world, and the hand (3,) that drags it."""
    return viser.SceneNodeDragEvent(
        client=client,
        client_id=client.client_id,
        target=target,
        phase=phase,
        instance_index=None,
        start_position=point(grabbed),
        start_screen_pos=MIDDLE,
        end_position=point(hand),
        end_screen_pos=MIDDLE,
        button="left",
        modifier=modifier,
    )


def point(values: Any) -> tuple[float, float, float]:
    """Three numbers as viser sends them."""
    x, y, z = (float(v) for v in values)
    return x, y, z
