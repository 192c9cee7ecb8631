"""Single-view metrology: metric camera height, cuboids and support edges from one photo and boxes.

`stage` is the public face; `box_observations` reads the boxes, `priors` the sizes, `problem` and `solver` state and
solve the batch, `floor` scans the camera's height, `supported_objects` and `placement` decide what holds what,
`reading` sums up.
"""

from diorama_core.perception.metrology.stage import SingleViewMetrology

__all__ = ["SingleViewMetrology"]
