"""The layout recipes by name, behind one protocol."""

from __future__ import annotations

from diorama_core.errors import InputError
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.settings import AS_IT_IS, Weights
from diorama_core.library.record import ShapeLibrary
from diorama_core.protocols import LayoutStage

NAMES = ("feasible", "paper", "all-in-one")
"""The default first."""


def recipe(
    name: str,
    library: ShapeLibrary,
    only: frozenset[str] | None = None,
    *,
    depth_measured: bool = False,
    sizes_reasoned: bool = False,
    weights: Weights = AS_IT_IS,
) -> LayoutStage:
    """The recipe of this name.

    Args:
        name: "feasible" (exact and fast, the default), "paper" (the published four stages) or "all-in-one" (every
            term at once, the paper's ablation).
        library: where shapes come from.
        only: ids free to move; everything else is constant.
        depth_measured: the observed distances were measured, not reasoned: the default recipe then keeps to them.
        sizes_reasoned: a photo alone gave distances and sizes: the default recipe then changes them together.
        weights: factors on what each cost counts; those a recipe does not know make no difference to it.

    Raises:
        InputError: when there is no such recipe.
    """
    if name == "feasible":
        depth_weight = 1.0 if depth_measured else FeasibleRecipe.depth_weight
        return FeasibleRecipe(
            library,
            only,
            depth_measured=depth_measured,
            depth_weight=depth_weight,
            sizes_reasoned=sizes_reasoned,
            weights=weights,
        )
    # torch takes two seconds to load, and the default recipe does without it.
    from diorama_core.layout.published.recipes import AllInOneRecipe, PaperRecipe

    if name == "paper":
        return PaperRecipe(library, only, weights=weights)
    if name == "all-in-one":
        return AllInOneRecipe(library, only, weights=weights)
    raise InputError(f"there is no layout recipe {name!r}; choose one of {', '.join(NAMES)}")
