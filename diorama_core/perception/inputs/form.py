"""A form of input: what it is, by which it is recognised, and how it is read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

Content = TypeVar("Content")
Read = TypeVar("Read")


@dataclass(frozen=True)
class Form(Generic[Content, Read]):
    """One row of a table of forms, and of the page *What goes in*."""

    name: str
    """What people call it, as in "COCO results"."""
    written_by: str
    """Programs and devices that write it."""
    understood: str
    """What is read of it and what is not, in one sentence for the page."""
    recognises: Callable[[Content], bool]
    """Whether content is of this form; never raises."""
    read: Callable[[Content], Read]
    """The values; raises `InputError` where content of this form is damaged."""


def form_of(forms: Sequence[Form[Content, Read]], content: Content) -> Form[Content, Read] | None:
    """The first form that recognises the content, or None."""
    return next((form for form in forms if form.recognises(content)), None)
