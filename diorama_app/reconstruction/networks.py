"""Networks, all optional: fetching them, and finding the furniture of a photo with one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diorama_app.session.client import Client
from diorama_core.artefacts import Box
from diorama_core.errors import EditRefused, InputError
from diorama_core.models.manifest import Network
from diorama_core.models.pull import pull
from diorama_core.models.store import ModelStore
from diorama_core.progress import Progress

NO_DETECTOR = "Detecting furniture needs a network: download “tiny” under Project, Networks."
SAME_IOU = 0.5
"""A detected box with at least this IoU with an existing box is a duplicate."""


def missing_networks(store: ModelStore, networks: Sequence[Network]) -> tuple[Network, ...]:
    """Networks that are not fully installed and can be downloaded."""
    return tuple(n for n in networks if n.pullable and not store.has(n))


def get_networks(client: Client, networks: Sequence[Network], accepted: frozenset[str]) -> None:
    """Fetch what is missing, in the background.

    Args:
        client: the requesting client.
        networks: what to fetch.
        accepted: ids of the networks whose licences this person was shown and accepts.
    """
    session, store = client.session, ModelStore.default()
    missing = missing_networks(store, networks)
    if not missing:
        raise EditRefused("these networks are all installed already")
    unknown = {n.id for n in missing} - store.accepted_licences() - accepted
    if unknown:
        raise InputError("accept the licences first; nothing was downloaded")

    def work(progress: Progress) -> None:
        fetched = pull(store, missing, accept=lambda asked: {n.id for n in asked} <= accepted, progress=progress)
        names = f"{len(fetched)} networks are" if len(fetched) != 1 else "The network is"
        client.post(lambda: session.notice_all(f"{names} ready and used from the next build on.", "good"))

    session.jobs.start("pull", "Downloading networks", work)


def find_furniture(client: Client) -> None:
    """Put a box around every piece of furniture that a detector finds in the photo, to be corrected by hand."""
    session = client.session
    photo = session.draft.photo
    if photo is None:
        raise InputError("there is no photo yet; upload one first")

    def work(progress: Progress) -> None:
        from diorama_core.pipeline.presets import propose_boxes  # the whole pipeline; opening a project does without

        found = propose_boxes(photo, progress=progress)
        if found is None:
            raise InputError(NO_DETECTOR)

        def show() -> None:
            draft = session.draft
            if draft.photo is not photo:
                return  # somebody uploaded another one meanwhile
            more = tuple(b for b in found if all(_iou(b.box, old.box) < SAME_IOU for old in draft.boxes))
            session.draft = replace(draft, boxes=(*draft.boxes, *more), highlighted=None)
            if more:
                client.open_board()
            session.refresh_panels()
            count = "1 more box" if len(more) == 1 else f"{len(more)} more boxes"
            words = (
                f"{count}: check the boxes, then build." if more else "No more furniture was detected in this photo."
            )
            client.notice(words, "good")

        client.post(show)

    session.jobs.start("find", "Detecting furniture", work)


def _iou(a: Box, b: Box) -> float:
    """Share of two boxes' union that both cover; boxes as left, top, right, bottom in pixels."""
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    both = max(width, 0.0) * max(height, 0.0)
    areas = sum((x2 - x1) * (y2 - y1) for x1, y1, x2, y2 in (a, b))
    return both / max(areas - both, 1e-9)
