"""Networks, all optional: downloading them, and detecting the furniture of a photo with one."""

from __future__ import annotations

from collections.abc import Sequence

from diorama_app.session.client import Client
from diorama_app.strings import N_, _, plural
from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.editing.input_corrections import with_boxes_added
from diorama_core.errors import EditRefused, InputError, UnavailableError
from diorama_core.io.assets import has_own_recogniser
from diorama_core.models.manifest import NETWORKS, networks_of
from diorama_core.models.network import Network
from diorama_core.models.pull import pull
from diorama_core.models.store import ModelStore
from diorama_core.progress import Progress

READY = ("The network is ready; the next build uses it.", "{count} networks are ready; the next build uses them.")
MORE_BOXES = ("{count} more box: check it, then build.", "{count} more boxes: check them, then build.")
NO_DETECTOR = N_("Detecting furniture needs a network: download “micro” under Project, Networks.")
PROPOSALS_ONLY = N_(
    "The proposals come from the small built-in detector, and some are wrong. A downloaded network finds more."
)
SMALLEST = "micro"
PULL_SHARE = 0.9
"""Share of the time that downloading takes of downloading and detecting."""


def can_find_furniture() -> bool:
    """Whether a network that finds furniture is on this machine, so that nobody needs to draw boxes."""
    store = ModelStore.default()
    return any(store.has(n) for n in NETWORKS if n.role == "detection")


def can_propose_boxes() -> bool:
    """Whether anything finds furniture, to be corrected by a person."""
    return can_find_furniture() or has_own_recogniser()


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
        raise EditRefused("all networks of this set are already installed")
    unknown = {n.id for n in missing} - store.read_accepted_licences() - accepted
    if unknown:
        raise InputError("accept the licences first; nothing was downloaded")

    def work(progress: Progress) -> None:
        _pull(client, missing, accepted, progress)

    session.jobs.start("pull", _("Downloading networks"), work)


def detect_with_networks(client: Client) -> None:
    """Fetch the smallest set of networks, then detect the furniture of the open photo with it.

    Whoever presses the button was shown the licences beside it, and accepts them.
    """
    session, photo = client.session, _photo(client)
    session.need_writable()
    missing = missing_networks(ModelStore.default(), networks_of(SMALLEST))

    def work(progress: Progress) -> None:
        _pull(client, missing, frozenset(n.id for n in missing), progress.part(0.0, PULL_SHARE))
        _find(client, photo, progress.part(PULL_SHARE, 1.0))

    session.jobs.start("pull", _("Downloading networks to detect furniture"), work)


def _pull(client: Client, missing: Sequence[Network], accepted: frozenset[str], progress: Progress) -> None:
    fetched = pull(
        ModelStore.default(), missing, accept=lambda asked: {n.id for n in asked} <= accepted, progress=progress
    )
    _try([n for n in missing if n.id in fetched], progress)
    message = plural(*READY, len(fetched))
    client.post(lambda: client.session.notice_all(message, "good"))


def _try(fetched: Sequence[Network], progress: Progress) -> None:
    """Let networks without published checksums look at the example; those that do not work are deleted."""
    if all(n.has_checksums for n in fetched):
        return
    from diorama_app.projects.example import example_inputs
    from diorama_core.pipeline.network_check import delete_failing_networks

    failed = delete_failing_networks(ModelStore.default(), [n.id for n in fetched], example_inputs().inputs, progress)
    if failed:
        damaged = "; ".join(f"{c.network.title}: {c.words}" for c in failed)
        raise UnavailableError(_("damaged or changed files were deleted: {files}").format(files=damaged))


def find_furniture(client: Client) -> None:
    """Put a box around every piece of furniture that a detector finds in the photo, to be corrected by hand."""
    session, photo = client.session, _photo(client)
    session.need_writable()
    session.jobs.start("find", _("Detecting furniture"), lambda progress: _find(client, photo, progress))


def _photo(client: Client) -> Photo:
    inputs = client.inputs
    if inputs is None:
        raise InputError("there is no photo yet; upload one first")
    return inputs.photo


def _find(client: Client, photo: Photo, progress: Progress) -> None:
    from diorama_core.pipeline.presets import propose_boxes  # the whole pipeline; opening a project does without

    boxes = propose_boxes(photo, progress=progress)
    if boxes is None:
        raise InputError(NO_DETECTOR)
    client.post(lambda: _put_boxes(client, photo, boxes))


def _put_boxes(client: Client, photo: Photo, boxes: Sequence[LabelledBox]) -> None:
    inputs = client.inputs
    if inputs is None or inputs.photo is not photo:
        return  # somebody opened another project here meanwhile
    marked = with_boxes_added(inputs, boxes)
    more = len(marked.boxes) - len(inputs.boxes)
    if not more:
        client.notice(_("No more furniture was detected in this photo."), "good")
        return
    client.selected_box = None
    client.annotate(_("detect furniture"), marked)
    client.open_board()
    client.refresh()
    client.notice(plural(*MORE_BOXES, more), "good")
