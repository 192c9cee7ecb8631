"""Pieces of HTML for the panels: escaped text, one style sheet, and a way for clicks in HTML to reach Python.

viser's panels have no tree and no picture grid. A piece of HTML carries `data-do` attributes; one inline handler writes
what was clicked into a hidden text field beside it, and that field's change arrives here.
"""

from __future__ import annotations

import html
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import viser

from diorama_app.viser_adapter import component_uuid

OnAction = Callable[["Action"], None]

STYLE = """
<style>
.dio { font-size: 13px; line-height: 1.4; color: #2b2f36; padding: 0 10px 8px 10px; }
.dio * { box-sizing: border-box; }
.dio h4 { margin: 8px 0 6px 0; font-size: 12px; font-weight: 600; color: #5b6472; letter-spacing: .01em; }
.dio p { margin: 0 0 6px 0; }
.dio .dim { color: #6b7482; }
.dio .card { background: #f4f6f8; border: 1px solid #e3e7ec; border-radius: 8px; padding: 9px 11px; }
.dio .warn { background: #fff6e6; border-color: #f0d9a8; }
.dio button { font: inherit; cursor: pointer; border: 1px solid #d5dbe3; background: #fff; color: #2b2f36;
  border-radius: 6px; padding: 4px 9px; }
.dio button:hover:not(:disabled) { background: #eef3fb; border-color: #9db7e0; }
.dio button:focus-visible, .dio [tabindex]:focus-visible { outline: 2px solid #2f6fd6; outline-offset: 1px; }
.dio button:disabled { opacity: .4; cursor: default; }
.dio button.on { background: #2f6fd6; border-color: #2f6fd6; color: #fff; }
.dio .bar { display: flex; gap: 4px; flex-wrap: wrap; margin-bottom: 6px; }
.dio .bar button { flex: 1 1 auto; white-space: nowrap; padding: 5px 8px; }
.dio .row { display: flex; align-items: center; gap: 4px; border-radius: 6px; padding: 2px 4px; cursor: pointer; }
.dio .row:hover { background: #eef3fb; }
.dio .row.on { background: #fdeadb; box-shadow: inset 3px 0 0 #ff7a1a; }
.dio .row .name { flex: 1 1 auto; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.dio .row.off .name { color: #9aa3af; }
.dio .row .tool { border: 0; background: transparent; padding: 2px 4px; opacity: .35; line-height: 0; }
.dio .row:hover .tool, .dio .row .tool.on { opacity: 1; background: transparent; color: inherit; }
.dio .row .dot { width: 9px; height: 9px; border-radius: 3px; flex: none; }
.dio .tree { border-left: 1px solid #dde2e8; margin-left: 9px; padding-left: 4px; }
.dio .grid { display: grid; grid-template-columns: repeat(3, 1fr); gap: 6px; }
.dio .tile { display: block; text-align: left; padding: 4px; border-radius: 8px; overflow: hidden; }
.dio .tile.on { background: #fdeadb; border-color: #ff7a1a; color: inherit; }
.dio .tile img, .dio .tile .blank { width: 100%; aspect-ratio: 1; object-fit: contain; display: block;
  border-radius: 5px; background: #eef1f4; }
.dio .tile .bar { flex-wrap: nowrap; gap: 3px; }
.dio .tile .bar button { padding: 2px 3px; font-size: 11.5px; }
.dio .tile b { display: block; font-size: 12px; font-weight: 500; line-height: 1.25; height: 2.5em; overflow: hidden;
  margin-top: 4px; }
.dio .tile small { display: block; font-size: 11px; color: #6b7482; white-space: nowrap; overflow: hidden; }
.dio table { width: 100%; border-collapse: collapse; font-size: 12px; }
.dio td { padding: 2px 0; vertical-align: top; } .dio td:last-child { text-align: right; }
.dio kbd { font: inherit; font-size: 11px; border: 1px solid #d5dbe3; border-bottom-width: 2px; border-radius: 4px;
  padding: 0 5px; background: #fff; }
.dio .job { display: flex; align-items: center; gap: 8px; }
.dio .job .words { flex: 1 1 auto; min-width: 0; }
.dio .meter { height: 6px; border-radius: 3px; background: #dde3ea; overflow: hidden; margin-top: 5px; }
.dio .meter i { display: block; height: 100%; background: #2f6fd6; transition: width .2s; }
.dio .small { width: 48px; height: 36px; object-fit: cover; border-radius: 4px; }
.dio .photo { width: 100%; border-radius: 8px; display: block; }
canvas[data-engine] { background: linear-gradient(#f3f5f8, #dfe4eb); }
</style>
"""

_SEND = (
    "const t=event.target.closest('[data-do]');if(t&&!t.disabled){event.stopPropagation();"
    "const f=document.querySelector('label[for=&quot;%s&quot;]').closest('.mantine-Flex-root').querySelector('input');"
    "const v=JSON.stringify({do:t.dataset.do,arg:t.dataset.arg||'',add:event.shiftKey||event.ctrlKey||event.metaKey,"
    "at:Date.now()});"
    "Object.getOwnPropertyDescriptor(HTMLInputElement.prototype,'value').set.call(f,v);"
    "f.dispatchEvent(new Event('input',{bubbles:true}))}"
)


@dataclass(frozen=True)
class Action:
    """A click on something with `data-do`."""

    do: str
    arg: str
    add: bool
    """Shift, Ctrl or Cmd was held."""
    client_id: int


class LiveHtml:
    """A piece of a panel drawn as HTML, redrawn only when it differs, whose clicks call `on_action`."""

    def __init__(self, gui: viser.GuiApi, on_action: OnAction | None = None) -> None:
        self._body = ""
        self._frame = "%s"
        if on_action is not None:
            field = gui.add_text("·", "")
            uuid = component_uuid(field)
            gui.add_html(f'<style>div:has(> .mantine-Flex-root label[for="{uuid}"]){{display:none}}</style>')
            self._frame = f'<div class="dio" onclick="{_SEND % uuid}">%s</div>'

            async def clicked(event: viser.GuiEvent[Any]) -> None:
                action = _read_action(event)
                if action is not None:
                    on_action(action)

            field.on_update(clicked)
        else:
            self._frame = '<div class="dio">%s</div>'
        self._handle = gui.add_html("", visible=False)

    def show(self, body: str) -> None:
        """Draw this HTML; nothing at all when empty. The caller escapes every name in it (`text`)."""
        if body == self._body:
            return
        self._body = body
        self._handle.content = self._frame.replace("%s", body, 1) if body else ""
        self._handle.visible = bool(body)

    @property
    def body(self) -> str:
        """What is drawn now."""
        return self._body


def text(value: object) -> str:
    """Escape for HTML content and attributes."""
    return html.escape(str(value), quote=True)


def button(label: str, do: str, arg: object = "", *, title: str = "", on: bool = False, disabled: bool = False) -> str:
    """A button whose click is the action `do` with `arg`; the label is HTML already (icons), the rest is escaped."""
    attributes = f'type="button" data-do="{text(do)}" data-arg="{text(arg)}" title="{text(title)}"'
    return f'<button class="{"on" if on else ""}" {attributes} {"disabled" if disabled else ""}>{label}</button>'


def _read_action(event: viser.GuiEvent[Any]) -> Action | None:
    if event.client_id is None:
        return None
    try:
        message = json.loads(event.target.value)
        return Action(str(message["do"]), str(message["arg"]), bool(message["add"]), event.client_id)
    except (ValueError, KeyError, TypeError):
        return None  # typed by hand, or by a page that is not ours
