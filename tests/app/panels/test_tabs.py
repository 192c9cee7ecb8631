from __future__ import annotations

import html

from diorama_app.panels.tabs import STORED_AS, Tabs
from tests.app.page import Page


def test_the_page_is_told_which_tabs_stand_together(page: Page) -> None:
    Tabs(page, (("Scene", "Photo"), ("Object",)))
    script = html.unescape(page.html)
    assert '[["Scene", "Photo"], ["Object"]]' in script
    assert f'"{STORED_AS}"' in script


def test_asking_for_the_same_tab_again_runs_again(page: Page) -> None:
    tabs = Tabs(page, (("Scene", 'It\'s "quoted"'),))
    seen = []
    for _ in range(2):
        tabs.open('It\'s "quoted"')
        seen.append(html.unescape(page.made[-1][2].content))
    assert seen[0] != seen[1]
    assert all(r'window.__dioOpenTab("It' in s and r"\"quoted\"" in s for s in seen)
