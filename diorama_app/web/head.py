"""What stands at the head of the page: our title, a sign that it loads, styles, and scripts that run before viser's."""

from __future__ import annotations

import re
from pathlib import Path

STATIC = Path(__file__).parents[1] / "static"
SCRIPTS = sorted(STATIC.glob("*.js"))
STYLES = sorted(STATIC.glob("*.css"))
TITLE = b"Diorama"


def with_head(page: bytes) -> bytes:
    """The page with our title, styles and scripts before everything that viser brings."""
    styles = b"".join(b"\n<style>" + style.read_bytes() + b"</style>" for style in STYLES)
    scripts = b"".join(b"\n<script>" + script.read_bytes() + b"</script>" for script in SCRIPTS)
    page = re.sub(rb"<title>.*?</title>", lambda _: b"<title>" + TITLE + b"</title>", page, count=1, flags=re.DOTALL)
    return page.replace(b"<head>", b"<head>" + styles + scripts, 1)
