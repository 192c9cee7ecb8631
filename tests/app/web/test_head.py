from __future__ import annotations

from diorama_app.web.responses import SCRIPTS, STYLES, with_head

PAGE = b"<html><head><title>Viser</title><script>viser()</script></head><body></body></html>"


def test_our_title_styles_and_scripts_come_first() -> None:
    page = with_head(PAGE)
    assert b"<title>Diorama</title>" in page
    assert b"Viser</title>" not in page
    assert page.count(b"\n<style>") == len(STYLES)
    assert page.count(b"\n<script>") == len(SCRIPTS)
    assert page.index(STYLES[0].read_bytes()) < page.index(SCRIPTS[0].read_bytes()) < page.index(b"viser()")
