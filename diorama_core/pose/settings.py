"""The numbers of posing, as fields of its stages."""

from __future__ import annotations

from dataclasses import dataclass

from diorama_core.geometry import see_through
from diorama_core.geometry.see_through import SeeThroughSettings


@dataclass(frozen=True)
class PoseEvidenceSettings:
    """How well a posed shape agrees with the picture; sigmas and weights of logarithms."""

    silhouette_weight: float = 0.7
    box_weight: float = 0.5
    seen_past_floor: float = 0.05
    of_contradicted: float = 0.75
    """What a cell of a mask loses of its weight that the picture's colours contradict."""
    silhouette_weight_with_depth: float = 0.7
    depth_weight: float = 0.7
    strength_with_depth: float = 2.0
    """Weight of measured depth, relative to an outline alone, against the pose priors."""
    of_sure_mask: float = 0.8
    """How much more the outline of a sure mask counts against the pose priors than that of a doubtful one."""
    of_sure_outline: float = 0.4
    """How much more it counts when shapes are compared: which one it is, is seen in the outline."""
    noise_floor: float = 0.03
    """Error below which two poses count as equal: the resolution of the silhouettes."""
    stretch_sigma: float = 0.3
    stretch_sigma_of_flat: float = 1.0
    enlarged_sigma: float = 0.2
    enlarged_sigma_reasoned: float = 0.5
    """Where sizes follow from a photo alone, and are those of the kind as much as of the thing."""
    likelihood_sigma: float = 0.15
    likelihood_floor: float = 0.02
    strength_of_shapes: float = 3.0
    """As `_STRENGTH_WITH_DEPTH`, when shapes are compared: outline and depth show which one it is."""
    misfit_sigma: float = 0.2
    normals_share: float = 0.4
    min_normals_share: float = 0.05
    """Below which normals are not worth their price."""
    calm: float = 0.006
    """Noise (as a share of the depth) up to which single pixels say more than means, which blur thin parts."""
    normals_noise: float = 0.01
    """Noise at which normals say half as much."""
    min_surface_cells: float = 4.0
    noise_samples: int = 40000
    level_sigma_m: float = 0.08
    """How well the picture tells the height at which a thing lies."""
    level_share_sigma: float = 0.08
    """Share of the height of what carries it: large things are measured less exactly."""
    max_level_cost: float = 4.0
    """Cost of a shape without any surface near: a thing may lie elsewhere than it seems."""
    wall_sigma_m: float = 0.05
    """How far a shape's box reaches into a wall that its object stands against."""
    max_wall_sigmas: float = 3.0
    """Deeper ones say no more: the surface may be no wall."""
    beside_m: float = 0.2
    """A corner meets the wall where it was seen this near to the corner's foot on it."""
    seen_behind_share: float = 0.05
    """A surface with a larger share of the object's own points behind it does not bound the object."""
    max_samples: int = 400
    whole_cell: float = 0.95
    """Cells of which less shows the object are its outline."""
    smooth: float = 0.7
    blur: float = 1.0
    """Cells: of the picture before its gradient, and of the gradients, so that edges may lie a little off."""
    turn: float = 60.0
    step: float = 2000.0
    """Strength of an edge, in grey levels, where the normal turns by a radian, or inverse depth steps by its own
    size."""
    strongest: float = 40.0
    """Grey levels a cell: an edge of a shape is one, however deep it is."""
    near_m: float = 0.05
    nothing: float = 1e-6
    of_edges: float = 5.0
    of_parts: float = 3.0
    """What a correlation of edges, and a share of the colours explained, say as a logarithm."""
    min_part_cells: int = 30
    """Cells that a shape covers, below which their colours tell no parts."""
    dark: float = 8.0
    """Grey levels added before logarithms: noise of dark pixels is no colour."""
    same_colour: int = 8
    """Parts whose sRGB values are this near count as one."""
    colour_noise: float = 1e-3
    """Sum of squared logarithms below which a picture has one colour."""
    see_through: SeeThroughSettings = see_through.SETTINGS


@dataclass(frozen=True)
class PoseSearchSettings:
    """Which poses of a shape are tried, and how they are refined and chosen."""

    thin_m: float = 0.1
    same_place: float = 0.15
    long_ratio: float = 1.25
    """Ratio of a cuboid's sides from which on it matters which one is the longer."""
    turned_misfit: float = 0.15
    """Misfit, as a logarithm of extents, that is held against turning the cuboid itself."""
    slope_step: float = 1e-3
    beyond_sigma: float = 4.0
    hidden_side: float = 0.2
    away_share: float = 0.05
    away_share_unseen: float = 0.01
    """Shares of its distance that an object may be expected to move along the ray: foot seen, and not."""
    sigmas: float = 2.3
    quarters: int = 4
    flat_m: float = 0.08
    thin_share: float = 0.1
    """Share of the largest extent: frames, panels and rugs come in any thickness."""
    thicker: float = 3.0
    """How much thicker than it was made a flat shape may stand for a thing without a name: no rug is as high as a
    table."""
    degenerate_m: float = 1e-3
    own_size_factor: float = 1.3
    """Whatever its kind's usual size, a shape may be this much smaller or larger than it was made."""
    min_rays: int = 6
    """Minimum number of measured points for a fit."""
    max_rays: int = 260
    directions: int = 16
    looseness: tuple[float, ...] = (4.0, 3.0, 2.0, 1.5, 1.0, 1.0, 1.0, 1.0)
    """Factors of the tolerances, by iteration, so that far starts are drawn in."""
    damping: float = 0.01
    max_shift: float = 0.6
    """A fit moves a pose by at most this share of its largest extent: farther ones lost hold of the object."""
    grazing: float = 0.15
    noise_reach: float = 1.8
    """Deviations by which noise widens the first and last hundredth of the points."""
    size_sigma: float = 0.22
    shape_sigma: float = 0.1
    """Expected deviation of one axis' log scale from the mean of the three."""
    thin_shape_sigma: float = 0.8
    """For thin axes."""
    sure_contact_m: float = 0.02
    shape_foot_m: float = 0.03
    """Usual distance of a shape's foot from that of the thing it stands for, beside the contact's own uncertainty."""
    max_sigmas: float = 3.0
    """Gaps of more deviations say no more: the contact may be wrong."""
    turns: int = 24
    elsewhere: float = 4.0
    """What speaks against a pose that shares nothing with a sure box and nothing with the picture, as a logarithm."""
    fit_steps: int = 8
    """Points along each side of a box's plan that tell how much of it another covers."""
    foot_px: int = 8
    """So many of a mask's pixels are its lowest."""
    floats_m: float = 0.05
    """A lower end that is seen this far from where the cuboid ends tells where the object stands."""
    own_share: float = 0.35
    absent: float = -0.7
    overlap: float = 0.5
    tie: float = 0.15
    """Two shapes whose log ranks differ by less are as good for one thing of a set: then it takes what the set
    likes."""
    max_loss_with_depth: float = 1.0
    """Maximum cost of agreement where depth was measured, since depth shows when objects differ."""
    max_loss_of_sure_outlines: float = 1.0
    """For things that come in no sets where their masks are sure: these show it, too."""
    max_loss_where_colours_tell: float = 0.5
    """For things that are told from what is seen through and past them."""
    retrieval_with_depth: float = 4.0
    """What retrieval says beside `Evidence.log_likelihood` where depth was measured: that tells shapes apart."""
    min_standing: float = -1.0
    """What holds an object may be mistaken: that a shape does not stand there says at most so much against it, as a
    log."""
    left_unrefined: float = 0.5
    """What poses gain by being refined, as a logarithm, in the middle."""
    loss_for_a_set: float = 0.02
    """Additional image error allowed for an object to take the size of its set."""
    powers: tuple[float, float] = (1.5, 0.6)
    """How much retrieval and pose say about which shape is best: the picture's outline alone would ignore colours."""
    powers_of_unnamed: tuple[float, float] = (3.0, 0.6)
    """For a thing without a name: shapes of many kinds compete, and some unlike thing always has its outline."""
    wall_samples: int = 3000
    """Enough that ten of them lie on whatever of a wall stands out beside a piece of furniture."""
    max_log_difference: float = 0.3
    """Farther apart they are not the same thing, or one of them was measured wrongly altogether."""
    tells: float = 0.5
    """What colours must say beside a mask for it to tell who of a set differs (`SeeThrough.share`)."""


@dataclass(frozen=True)
class ShapeFitSettings:
    """How shapes are made to measure, and which of those made is chosen."""

    good_fit: float = 0.08
    """Disagreement with the picture, 0 to 1, below which the first candidate stays."""
    poor_fit: float = 0.3
    """Disagreement from which on the next ones are fitted from a photo alone."""
    compared: int = 3
    turned: int = 2
    uneven: int = 2
    """Candidates that are fitted in that case; bodies of revolution, and shapes with a left and a right, that are
    fitted whenever the outline is sure."""
    of_rank: float = 1.0
    of_fit: float = 2.0
    """What the ranks from before the fit and the fits themselves say of them, as factors of logarithms."""
    of_edges: float = 1.0
    """What the correlation of inner edges says beside them: books on a top and what a mask missed change its outline.
    Less of a thing that is hidden."""
    no_score: float = 1e-3
    resized_sigma: float = 0.3
    """Standard deviation of an extent's logarithm against where it was, of things that are seen whole."""
    of_border: float = 2.0
    """A box has two opposite pairs of sides: half of it on the photo's border leaves an extent open."""
    min_seen: float = 0.05
    min_trust: float = 0.5
    """Masks that are trusted less do not say it so exactly, unless depth does."""
    worth: float = 0.25
    worth_with_depth: float = 0.15
    worth_of_unsure: float = 0.4
    """A changed parameter must agree better by so much: without depth it may make up for a pose that is a little off,
    and where no one drew the mask also for what the mask missed or took for the object."""
    size_loss: float = 0.1
    """A shape stretched unevenly is rather built at that size, unless it agrees worse by so much."""
    promising: float = 0.45
    promising_with_depth: float = 0.75
    """A fit raises the score of a value in the pose of the best one by less, in 99 of 100 of 655 cases, of which 12
    were worth it: what lacks more is not fitted."""
    size_steps: tuple[float, float] = (0.03, 0.015)
    size_rounds: int = 3
    """Steps and rounds of the fits of single values: they begin where the shape fits with other ones."""
    finely: float = 0.25
    """Finer steps raise a score by no more than this, mostly by a fifth of it: values that need more are not fitted
    on."""
    min_drawer_m: tuple[float, float] = (0.2, 0.08)
    """Width and height of the front of a drawer, at least."""
    passes: int = 2
    max_variants: int = 32
    """Times that all parameters are gone through, since one may hide another, and shapes built for one object or
    set."""
    max_triangles: int = 20_000
    """Designs of more triangles, such as plants, are not built again and again."""
    min_pixels: int = 900
    """Only place and size are fitted of objects of fewer pixels: their parts are a pixel or two."""
    cells: int = 56
    fine_cells: int = 84
    """Resolutions at which shapes are compared with the picture and set in place in the end, both ways."""
    outline: float = 1.8
    outline_with_depth: float = 2.0
    """How much outline and depth say, as a factor of a logarithm; an outline counts as much as its mask is trusted."""
    edges: float = 1.0
    """How much the inner edges say beside that."""
    sure_mask: float = 0.9
    given_mask: float = 1.0
    """Confidence from which on a mask's outline tells a profile, and that of a mask that was given."""
    min_cells: float = 100.0
    """Objects of which fewer cells are seen tell nothing of their parts."""
    inset: float = 0.05
    """Share of the height by which the lowest and the highest circle are within the body: a height is not that
    exact."""
    max_outside: float = 0.06
    """Share of a circle that may lie beside the outline: its resolution."""
    min_known: float = 0.2
    """Share of the widest circle that must be seen."""
    covered: float = 0.5
    known: float = 0.9
    """A place is within the outline when so much of it is covered, and known when it says so much: not where something
    that hides the object begins."""
    max_narrow: int = 2
    """Heights at which the body may be narrower than can be made: at more of them it is no such body, or not as
    high."""
    much_better: float = 0.85
    """Another profile must bring the disagreement with the picture, and what two shapes may differ by, below this
    share; the lower, the more the body is resized: a glass seen from above became a bowl."""
    max_faces: int = 5000
    """Triangles or sectors of a shape: the wires of a basket are no profile."""
    sectors: int = 8
    max_uneven: float = 0.15
    min_even: float = 0.7
    """A section is even when its reach in these sectors differs by at most this share, and so many sections are."""


@dataclass(frozen=True)
class PoseSettings:
    """All numbers of `RenderAndCompare` and `MadeToMeasure`."""

    evidence: PoseEvidenceSettings = PoseEvidenceSettings()
    search: PoseSearchSettings = PoseSearchSettings()
    shapes: ShapeFitSettings = ShapeFitSettings()


SETTINGS = PoseSettings()
