"""One page in its browser: its address names its project, the tabs that were open last are open again after a reload,
and on a phone it shows one panel.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Sequence

import viser

from diorama_app.panels.fields import PageScript
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, run_once


class Address:
    """The address of one page."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._script = PageScript(gui)

    def go_to(self, project: str) -> None:
        """Take the page to a project, by the name of its folder; Back leads here again."""
        self._script.run(f"window.__dioGoTo({json.dumps(project)});", again=True)


STORED_AS = "diorama-tabs"
TRIES = 200
"""Number of attempts to find the tabs while the page loads, 50 ms apart."""

_KEEPER = """
const names = %s, key = %s;
const tabs = () => [...document.querySelectorAll('[role=tab]')];
const named = (tab) => tab.textContent.trim();
const enter = (tab) => {
  tab.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }));
  tab.click();
};
const read = () => { try { return JSON.parse(localStorage.getItem(key)) || []; } catch { return []; } };
const note = () => {
  const open = tabs().filter((t) => t.getAttribute('aria-selected') === 'true').map(named);
  try { localStorage.setItem(key, JSON.stringify(open)); } catch { window.__dioTabs = 'not remembered'; }
};
const recall = (left) => {
  if (!window.__dioRecalls) return;
  const there = tabs();
  if (names.some((name) => !there.some((t) => named(t) === name))) {
    if (left) setTimeout(() => recall(left - 1), 50);
    return;
  }
  const lists = new Set(there.map((t) => t.closest('[role=tablist]')));
  const remembered = lists.size > 1 ? read() : read().slice(0, 1);
  for (const tab of there)
    if (remembered.includes(named(tab)) && tab.getAttribute('aria-selected') !== 'true') enter(tab);
  const wanted = there.find((t) => named(t) === window.__dioTabWanted);
  if (wanted) enter(wanted);
};
window.__dioRecalls = true;
window.__dioOpenTab = (name, number) => {
  if (window.__dioTabsAsked === number) return;
  window.__dioTabsAsked = number;
  const again = (left) => {
    const tab = tabs().find((t) => named(t) === name);
    if (tab && tab.getAttribute('aria-selected') !== 'true') enter(tab);
    if (left) setTimeout(() => window.__dioTabWanted === name && again(left - 1), 50);
    else { delete window.__dioTabWanted; note(); }
  };
  window.__dioTabWanted = name;
  again(40);
};
recall(%d);
if (!window.__dioTabs) {
  window.__dioTabs = 'remembered';
  for (const kind of ['pointerdown', 'keydown'])
    document.addEventListener(kind, (e) => {
      if (e.isTrusted && e.target.closest('[role=tab]')) { delete window.__dioTabWanted; window.__dioRecalls = false; }
    }, true);
  for (const kind of ['pointerup', 'keyup'])
    document.addEventListener(kind, () => setTimeout(note, 200), true);
}
"""
"""viser's tabs answer to a press of the mouse, not to a click; a key does the same. Those of a phone answer to a click
only. A tab that is opened is opened again where others are made meanwhile (a phone's), until a person chooses one. Of
two tabs that were open side by side a phone, with one list, opens the left one."""


_REQUESTS = itertools.count(1)
"""Numbers of requests, of all pages: a page may come to another project without being loaded again."""


class Tabs:
    """The tabs of one page."""

    def __init__(self, gui: viser.GuiApi, tabs: Sequence[str]) -> None:
        """Open the tabs, named from left to right, that were open the last time, and note which are from now on."""
        gui.add_html(run_once(_KEEPER % (json.dumps(list(map(_, tabs))), json.dumps(STORED_AS), TRIES)))
        self._opener = PageScript(gui)

    def open(self, name: str) -> None:
        """Bring a tab to the front."""
        opening = f"window.__dioOpenTab && window.__dioOpenTab({json.dumps(_(name))}, {next(_REQUESTS)});"
        self._opener.run(opening)


class PanelLayout:
    """Hidden buttons that the page presses by itself: where there is room for one panel, and once both are there."""

    def __init__(
        self, gui: viser.GuiApi, client: Client, gather: Callable[[], None], widen: Callable[[], None]
    ) -> None:
        """Put the buttons on the page.

        Args:
            gui: the page.
            client: the owner.
            gather: moves all tabs into one panel; called once.
            widen: gives the panels their widths: a page that is slow may have lost those that came with them.
        """
        self._client, self._gather, self._widen = client, gather, widen
        self._gathered = self._widened = False
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))

    def refresh(self) -> None:
        """Draw each button until it was pressed."""
        left = ("one panel", *(() if self._widened else ("two panels",)))
        hidden = "".join(
            f'<button type="button" id="dio-{do.replace(" ", "-")}" data-do="{do}" hidden></button>' for do in left
        )
        self._html.show("" if self._gathered else hidden)

    def _do(self, action: Action) -> None:
        if action.do == "one panel" and not self._gathered:
            self._gathered = True
            self._gather()
        elif action.do == "two panels" and not self._gathered:
            self._widened = True
            self._widen()
            self.refresh()
