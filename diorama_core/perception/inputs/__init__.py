"""Everything a person hands in for a scene: recognised by its content, read into one form, or refused in one line.

Each sort of input (photos, boxes, masks, depth) has a table of forms. A form says what a file is and reads it; what was
understood comes back as notes. `docs/what-goes-in.md` is made from the same tables.
"""

from diorama_core.perception.inputs.reading import ReadInputs, read_inputs

__all__ = ["ReadInputs", "read_inputs"]
