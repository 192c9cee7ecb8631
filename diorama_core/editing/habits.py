"""Where people put things where nobody says: at walls, under tables, on what, and with what before them."""

from __future__ import annotations

from collections.abc import Sequence

from diorama_core.editing.relations import Relation
from diorama_core.library.taxonomy import broad, category
from diorama_core.scene.types import Scene, SceneObject

AT_WALLS = frozenset({
    "bed", "sofa", "wardrobe", "dresser", "cabinet", "sideboard", "console table", "tv stand", "bookshelf", "desk",
    "refrigerator", "stove", "washing machine", "kitchen counter", "sink", "toilet", "bathtub", "night stand", "piano",
    "fireplace", "shower", "radiator", "grandfather clock", "floor mirror",
})  # fmt: skip
"""Categories whose back belongs to a wall."""
FREE_STANDING = frozenset({"kitchen island"})
"""Special kinds of these that people walk around."""
MID_WALL = frozenset(
    {"sofa", "bed", "tv stand", "fireplace", "sideboard", "console table", "dresser", "kitchen counter"}
)
"""Of these, what stands in the middle of its wall rather than in a corner."""
TUCKED = {"chair": ("table", "desk"), "office chair": ("table", "desk"), "stool": ("table", "desk", "kitchen counter"),
          "bench": ("table",), "ottoman": ("coffee table",)}  # fmt: skip
"""Seats that are pushed under something as far as the meshes allow."""
NOT_FOR_THINGS = ("rug", "chair", "stool", "bench", "ottoman", "sofa", "bed", "armchair", "box")
"""They carry things only where somebody says so."""


def carries(item: SceneObject) -> bool:
    """Whether people put things on it without being told to."""
    kind = category(item.category)
    return kind.supports_objects and broad(item.category) not in (
        "rug",
        "chair",
        "stool",
        "sofa",
        "bed",
        "armchair",
        "box",
    )


USUAL_HOSTS = {
    "television": ("tv stand",), "monitor": ("desk",), "keyboard": ("desk",), "laptop": ("desk", "table"),
    "pillow": ("sofa", "bed", "armchair"), "microwave": ("kitchen counter",), "kettle": ("kitchen counter",),
    "toaster": ("kitchen counter",), "lamp": ("night stand", "side table", "desk", "sideboard", "dresser"),
    "fruit": ("table", "kitchen counter"), "cup": ("table", "coffee table", "desk"),
    "vase": ("table", "sideboard", "coffee table"),
}  # fmt: skip
"""What things lie on, the likeliest first."""


def host_cost(item: SceneObject, host: SceneObject) -> float:
    """How unlikely it is that people put one on the other."""
    usual = USUAL_HOSTS.get(broad(item.category), ())
    if broad(host.category) in usual:
        return 0.1 * usual.index(broad(host.category))
    return 0.6 + (0.4 if host.size_m[2] > 1.3 else 0.0)


def pushed_under(item: SceneObject) -> tuple[str, ...]:
    """Categories under which an object is pushed."""
    return TUCKED.get(broad(item.category), ())


def belongs_before(item: SceneObject, host: SceneObject, relations: Sequence[Relation]) -> bool:
    """Whether an object is meant to be on the floor before another: its seat, its table, or as wished."""
    if broad(host.category) in TUCKED.get(broad(item.category), ()):
        return True
    pairs = (("coffee table", "sofa"), ("coffee table", "armchair"), ("ottoman", "armchair"), ("ottoman", "sofa"))
    if (broad(item.category), broad(host.category)) in pairs or broad(item.category) == "rug":
        return True
    return any(
        host.id in r.targets or item.id in r.targets for r in relations if r.kind in ("in front of", "around", "facing")
    )


def stands(scene: Scene, item: SceneObject) -> bool:
    """Whether an object stands on the floor or on a rug."""
    edge = scene.support_of(item.id)
    if edge is None or not scene.has_object(edge.parent):
        return category(item.category).mount == "floor"
    return broad(scene.object(edge.parent).category) == "rug"
