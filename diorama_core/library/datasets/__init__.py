"""Published data sets of shapes, read from a local copy in the layout in which they are distributed.

Nothing is downloaded, and each licence stays what it is. A data set says which files are its models, what they are and
how they stand; taking them in is the same as for anyone's own models.
"""

from diorama_core.library.datasets.published import (
    DATASETS,
    Dataset,
    DatasetEntry,
    as_sources,
    dataset_named,
    recognise,
)

__all__ = ["DATASETS", "Dataset", "DatasetEntry", "as_sources", "dataset_named", "recognise"]
