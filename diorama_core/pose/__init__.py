"""Where every ranked shape stands, how it is turned and how large it is, and what it is like made to measure."""

from diorama_core.pose.made_to_measure import MadeToMeasure
from diorama_core.pose.render_and_compare import RenderAndCompare

__all__ = ["MadeToMeasure", "RenderAndCompare"]
