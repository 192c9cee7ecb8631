"""Where every ranked shape stands, how it is turned and how large it is."""

from diorama_core.pose.render_and_compare import RenderAndCompare

__all__ = ["RenderAndCompare"]
