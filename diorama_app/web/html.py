"""Pieces of HTML for the panels: escaped text, one style sheet, and a way for clicks in HTML to reach Python.

viser's panels have no tree and no picture grid. A piece of HTML carries `data-do` attributes; one inline handler sends
what was clicked as the value of a hidden text field beside it, and that field's change arrives here. The field may have
its next value before it is read, so it says the latest actions, numbered, and each is told once.
"""

from __future__ import annotations

import html
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import viser

from diorama_app.web.viser_adapter import component_uuid
from diorama_core.io.text import clean_strings

OnAction = Callable[["Action"], None]

STYLE = """
<style>
.dio, .dio-toast { --ink: #2b2f36; --dim: #59626f; --line: #d5dbe3; --soft: #f4f6f8; --card-line: #e3e7ec; --face: #fff;
  --hover: #eef3fb; --on: #fdeadb; --accent: #2f6fd6; --tile: #eef1f4; --warn: #fff6e6; --warn-line: #f0d9a8;
  --bad: #c62828; }
:root[data-mantine-color-scheme="dark"] .dio, :root[data-mantine-color-scheme="dark"] .dio-toast { --ink: #dfe3ea;
  --dim: #b3bcc9; --line: #454c58; --soft: #2a2e35; --card-line: #3a404a; --face: #30353d; --hover: #363d49;
  --on: #57402c; --accent: #2f6fd6; --tile: #e4e8ed; --warn: #443a20; --warn-line: #6b5a2c; --bad: #ff8f85; }
.dio { font-size: 13px; line-height: 1.4; color: var(--ink); padding: 0 10px 8px 10px; }
.dio * { box-sizing: border-box; }
.dio h4 { margin: 8px 0 6px 0; font-size: 12px; font-weight: 600; color: var(--dim); letter-spacing: .01em; }
.dio p { margin: 0 0 6px 0; }
.dio .dim { color: var(--dim); }
.dio .bad { color: var(--bad); }
.dio .why { margin: 0 0 8px 0; padding: 0; list-style: none; font-size: 12px; color: var(--dim); }
.dio .card { background: var(--soft); border: 1px solid var(--card-line); border-radius: 8px; padding: 9px 11px; }
.dio .warn { background: var(--warn); border-color: var(--warn-line); }
.dio button, .dio select, .dio input { font: inherit; border: 1px solid var(--line); background: var(--face);
  color: var(--ink); border-radius: 6px; padding: 4px 9px; }
.dio button { cursor: pointer; }
.dio input, .dio select { width: 100%; min-width: 0; }
.dio button:hover:not(:disabled):not(.on) { background: var(--hover); border-color: #9db7e0; }
.dio button:focus-visible, .dio input:focus-visible, .dio [tabindex]:focus-visible {
  outline: 2px solid var(--accent); outline-offset: 1px; }
.dio button:disabled { opacity: .4; cursor: default; }
.dio button.on { background: var(--accent); border-color: var(--accent); color: #fff; }
.dio .fields { display: grid; grid-template-columns: repeat(3, 1fr); gap: 4px 6px; margin-bottom: 4px; }
.dio .fields label { font-size: 11px; color: var(--dim); min-width: 0; }
.dio .fields input, .dio .fields select { display: block; width: 100%; font-size: 13px; padding: 4px 6px; }
.dio .fields.four { grid-template-columns: repeat(4, 1fr); }
.dio .bar { display: flex; gap: 4px; flex-wrap: wrap; margin-bottom: 6px; }
.dio .bar button { flex: 1 1 auto; white-space: nowrap; padding: 5px 8px; }
.dio .bar button:only-child { flex: 0 1 auto; }
.dio .three { display: grid; grid-template-columns: repeat(3, 1fr); gap: 4px; margin-bottom: 6px; }
.dio .three button { padding: 4px 5px; font-size: 12px; }
.dio .tight button { padding: 4px 5px; font-size: 12px; }
.dio .one-row { flex-wrap: nowrap; gap: 3px; }
.dio .one-row button { padding: 4px 2px; }
.dio .wide button { flex: 1 1 100% !important; padding: 7px 8px; }
.dio .switch { display: flex; gap: 9px; width: 100%; border-color: transparent; background: transparent;
  padding: 3px 2px; text-align: left; line-height: 1.25; }
.dio .switch i { flex: none; width: 26px; height: 16px; margin-top: 1px; border-radius: 8px; background: #8a94a3;
  position: relative; }
.dio .switch i::after { content: ""; position: absolute; left: 2px; top: 2px; width: 12px; height: 12px;
  border-radius: 50%; background: #fff; transition: left .12s; }
.dio .switch[aria-checked=true] i { background: var(--accent); }
.dio .switch[aria-checked=true] i::after { left: 12px; }
.dio .switch small { display: block; font-size: 11.5px; color: var(--dim); }
.dio .lead { align-self: center; margin-right: 4px; }
.dio .row { display: flex; align-items: center; gap: 4px; border-radius: 6px; padding: 2px 4px; cursor: pointer; }
.dio .row:hover { background: var(--hover); }
.dio .row.on { background: var(--on); box-shadow: inset 3px 0 0 #ff7a1a; }
.dio .row.over { box-shadow: inset 0 0 0 2px var(--accent); }
.dio .row .name { flex: 1 1 auto; min-width: 0; overflow-wrap: break-word; line-height: 1.25; }
.dio .row.tall { flex-wrap: wrap; justify-content: flex-end; padding: 5px 4px; }
.dio .row.tall .name { flex: 1 0 calc(100% - 60px); }
.dio .row.tall .name > * { display: block; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.dio .row.tall b { font-weight: 500; }
.dio .row.off .name { opacity: .5; }
.dio .row .tool { border: 0; background: transparent; padding: 2px 4px; opacity: .35; line-height: 0; }
.dio .row:hover .tool, .dio .row .tool.on { opacity: 1; background: transparent; color: inherit; }
.dio .row .dot { width: 9px; height: 9px; border-radius: 3px; flex: none; }
.dio .row .who { width: 9px; height: 9px; border-radius: 50%; flex: none; }
.dio .chip { font-size: 10.5px; line-height: 1; border-radius: 8px; padding: 3px 6px; background: var(--warn);
  border: 1px solid var(--warn-line); white-space: nowrap; flex: none; }
.dio .chip.bad { background: transparent; border-color: currentColor; }
.dio .tree { border-left: 1px solid var(--line); margin-left: 9px; padding-left: 4px; }
.dio .grid { display: grid; grid-template-columns: repeat(3, 1fr); gap: 6px; }
.dio .grid.two { grid-template-columns: repeat(2, 1fr); }
.dio .tile { display: block; text-align: left; padding: 4px; border-radius: 8px; overflow: clip; min-width: 0; }
.dio div.tile { border: 1px solid var(--line); }
.dio .tile.on { background: var(--on); border-color: #ff7a1a; color: inherit; }
.dio .tile img, .dio .tile .blank { width: 100%; aspect-ratio: 1; object-fit: contain; display: block;
  border-radius: 5px; background: var(--tile); }
.dio div.tile { position: relative; }
.dio .tile .star { position: absolute; top: 5px; right: 5px; padding: 1px 5px; line-height: 1.2; border-radius: 6px; }
.dio .tile .star[aria-pressed=true] { color: #b45309; }
:root[data-mantine-color-scheme="dark"] .dio .tile .star[aria-pressed=true] { color: #ffb35c; }
.dio .filters { display: grid; gap: 4px; grid-template-columns: 1fr 1fr; margin-bottom: 6px; }
.dio .filters select:first-child { grid-column: 1 / 3; }
.dio .tile .bar { flex-wrap: nowrap; gap: 3px; }
.dio .tile .bar button { padding: 2px 3px; font-size: 11.5px; }
.dio .tile b { display: block; font-size: 12px; font-weight: 500; line-height: 1.25; height: 2.5em; overflow: hidden;
  margin-top: 4px; }
.dio .tile small { display: block; font-size: 11px; color: var(--dim); white-space: nowrap; overflow: hidden; }
.dio .sample { display: block; width: 100%; aspect-ratio: 4 / 3; border-radius: 5px; background-size: cover; }
.dio .swatches { display: flex; flex-wrap: wrap; gap: 4px; margin-bottom: 6px; }
.dio .swatches button { padding: 2px; border-radius: 50%; line-height: 0; }
.dio .swatches button.on { background: transparent; border-color: #ff7a1a; box-shadow: 0 0 0 1px #ff7a1a; }
.dio .swatch { display: block; width: 22px; height: 22px; border-radius: 50%; box-shadow: inset 0 0 0 1px #0002; }
.dio input[type=color] { height: 29px; padding: 2px 3px; }
.dio table { width: 100%; border-collapse: collapse; font-size: 12px; }
.dio td { padding: 2px 0; vertical-align: top; } .dio td:last-child { text-align: right; }
.dio kbd { font: inherit; font-size: 11px; border: 1px solid var(--line); border-bottom-width: 2px; border-radius: 4px;
  padding: 0 5px; background: var(--face); white-space: nowrap; }
.dio .job { display: flex; align-items: center; gap: 8px; }
.dio .job .words { flex: 1 1 auto; min-width: 0; }
.dio .meter { height: 6px; border-radius: 3px; background: var(--line); overflow: hidden; margin-top: 5px; }
.dio .meter i { display: block; height: 100%; background: var(--accent); transition: width .2s; }
.dio .small { width: 48px; height: 36px; object-fit: cover; border-radius: 4px; flex: none; }
.dio .photo { width: 100%; border-radius: 8px; display: block; }
.dio .drop { border: 2px dashed var(--line); border-radius: 10px; padding: 12px; text-align: center; }
.dio .drop.over { border-color: var(--accent); background: var(--hover); }
.dio-toast { position: fixed; left: calc(var(--dio-left, 0px) + var(--dio-width, 100vw) / 2);
  bottom: calc(var(--dio-below, 0px) + 64px); transform: translateX(-50%); z-index: 900; display: flex;
  align-items: center; gap: 12px; max-width: calc(var(--dio-width, 100vw) - 24px); width: max-content;
  box-sizing: border-box; padding: 8px 12px; border-radius: 10px; font-size: 13px;
  color: #fff; background: #262b33ee; box-shadow: 0 4px 16px #0004; animation: dio-fade .7s 5.3s forwards; }
.dio-toast span { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.dio-toast button { font: inherit; font-weight: 600; cursor: pointer; border: 0; background: transparent;
  color: #8fc0ff; }
.dio-toast.long { animation-delay: 14s; }
.dio-toast span { white-space: normal !important; }
.dio-toast.stay { animation: none; background: #1d4f9eee; }
@keyframes dio-fade { 100% { opacity: 0; visibility: hidden; } }
.mantine-Paper-root:has(> .mantine-Paper-root + [aria-hidden=true]) { border-color: transparent;
  border-top-color: var(--mantine-color-default-border); margin-bottom: 0 !important; }
.mantine-Paper-root:has(> .mantine-Paper-root + [aria-hidden=true]) > :last-child > div { padding: 2px; }
</style>
"""

_SEND = html.escape("const S=(d,a,e)=>window.__dioSend('%s',d,a,e);")
"""Defines S(what to do, its argument, the event), for the hidden field with this id (`actions.js`)."""

_CLICK = html.escape(
    "const t=event.target.closest('[data-do]');"
    "if(t&&!t.disabled){event.stopPropagation();S(t.dataset.do,t.dataset.arg,event)}"
)
_CHANGE = html.escape(
    "const t=event.target.closest('[data-change]');"
    "if(t)S(t.dataset.change,JSON.stringify([t.dataset.arg||'',t.value]),event)"
)
_HOVER = html.escape(
    "const t=event.target.closest('[data-peek]'),k=t?t.dataset.peek:'';"
    "if(k!==(window.__dioPeek||'')){window.__dioPeek=k;clearTimeout(window.__dioWait);"
    "window.__dioWait=setTimeout(()=>S('peek',k,event),120)}"
)
_LEAVE = html.escape("if(window.__dioPeek){window.__dioPeek='';clearTimeout(window.__dioWait);S('peek','',event)}")
_GRAB = html.escape(
    "const t=event.target.closest('[data-grab]');"
    "if(t){event.dataTransfer.setData('text',t.dataset.grab);S('grab',t.dataset.grab,event)}"
)
_RELEASE = html.escape("if(event.dataTransfer.dropEffect==='none')S('release','',event)")
"""Only where nothing took it."""
_OVER = html.escape(
    "const t=event.target.closest('[data-drop]');"
    "document.querySelectorAll('.dio .row.over').forEach(o=>{if(o!==t)o.classList.remove('over')});"
    "if(t){event.preventDefault();t.classList.add('over')}"
)
_FLOAT = html.escape(
    "const n=this.parentElement,o=document.getElementById(n.dataset.float),a=document.activeElement,"
    "f=o&&o.contains(a)?a.dataset:null;if(o)o.remove();n.id=n.dataset.float;this.remove();"
    "if(n.dataset.empty)n.remove();else{document.body.appendChild(n);if(f&&f.do)[...n.querySelectorAll('[data-do]')]"
    ".find(b=>b.dataset.do===f.do&&b.dataset.arg===f.arg)?.focus()}"
)
"""Takes a piece of HTML out of its panel (which clips it) and lays it over the page, in place of its predecessor."""
_DROP = html.escape(
    "const t=event.target.closest('[data-drop]');if(t&&!event.dataTransfer.files.length){event.preventDefault();"
    "t.classList.remove('over');S('drop',JSON.stringify([event.dataTransfer.getData('text'),t.dataset.drop]),event)}"
)


@dataclass(frozen=True)
class Action:
    """Something done to a piece of HTML."""

    do: str
    arg: str
    add: bool
    """Shift, Ctrl or Cmd was held."""

    @property
    def parsed(self) -> Any:
        """The argument as a JSON value, its strings cleaned; raises `ValueError` where it is none."""
        try:
            return clean_strings(json.loads(self.arg))
        except RecursionError as error:
            raise ValueError("brackets within brackets") from error

    @property
    def pair(self) -> tuple[str, str]:
        """Two words in one argument: (argument, new value) of a change, (dragged, onto) of a drop."""
        try:
            first, second = self.parsed
        except (ValueError, TypeError):
            return "", ""
        return str(first), str(second)


class LiveHtml:
    """A piece of a panel drawn as HTML, redrawn only when it differs, whose events call `on_action`.

    Inside it, `data-do` (with `data-arg`) is clicked, `data-change` is an input whose new value is told, `data-peek` is
    pointed at, and rows with `data-grab` are dragged onto rows with `data-drop`.
    """

    def __init__(self, gui: viser.GuiApi, on_action: OnAction | None = None, *, floating: str = "") -> None:
        """Make an empty piece.

        Args:
            gui: the panel it is part of.
            on_action: told what is done to it, from viser's event loop.
            floating: a name of its own lets it float over the page instead of standing in the panel.
        """
        self._body: str | None = None if floating else ""
        """None: nothing was drawn yet, and what an earlier connection left floating over the page goes."""
        self._floating = floating
        self._count = 0
        self._done = 0
        """Number of the last action of the page that was told."""
        self._frame = '<div class="dio">%s</div>'
        if on_action is not None:
            field = gui.add_text("·", "")
            uuid = component_uuid(field)
            gui.add_html(f'<style>div:has(> .mantine-Flex-root label[for="{uuid}"]){{display:none}}</style>')
            send = _SEND % uuid
            handlers = {
                "click": _CLICK,
                "change": _CHANGE,
                "mouseover": _HOVER,
                "mouseleave": _LEAVE,
                "dragstart": _GRAB,
                "dragend": _RELEASE,
                "dragover": _OVER,
                "drop": _DROP,
            }
            events = " ".join(f'on{name}="{send}{script}"' for name, script in handlers.items())
            self._frame = f'<div class="dio" {events}>%s</div>'

            async def clicked(event: viser.GuiEvent[Any]) -> None:
                if event.client_id is None:
                    return
                for number, action in _read_actions(event.target.value):
                    if number > self._done:
                        self._done = number
                        on_action(action)

            field.on_update(clicked)
        self._handle = gui.add_html("", visible=False)

    def show(self, body: str, *, again: bool = False) -> None:
        """Draw this HTML; nothing at all when empty. The caller escapes every name in it (`text`).

        With `again` the same HTML starts over (its animation, what was typed into it).
        """
        if body == self._body and not again:
            return
        self._body = body
        if self._floating:
            empty = "" if body else 'data-empty="1"'
            out = f'<img alt="" src="data:," style="display:none" onerror="{_FLOAT}">'
            frame = self._frame.replace("<div ", f'<div data-float="{self._floating}" {empty} ', 1)
            self._handle.content = f"<!--{self._count}-->" + frame.replace("%s", body + out, 1)
            self._handle.visible = True
            self._count += 1
            return
        if again:
            self._count += 1  # the page draws only what differs
        mark = f"<!--{self._count}-->" if self._count else ""
        self._handle.content = mark + self._frame.replace("%s", body, 1) if body else ""
        self._handle.visible = bool(body)

    @property
    def body(self) -> str:
        """What is drawn now."""
        return self._body or ""


def run_once(script: str) -> str:
    """HTML that runs a script when it is drawn, and shows nothing. The script has no comments to the end of a line."""
    code = html.escape(" ".join(line.strip() for line in script.splitlines()))
    return f'<div style="display:none"><img alt="" src="data:," onerror="{code}"></div>'


def text(value: object) -> str:
    """Escape for HTML content and attributes."""
    return html.escape(str(value), quote=True)


def button(label: str, do: str, arg: object = "", *, title: str = "", on: bool = False, disabled: bool = False) -> str:
    """A button whose click is the action `do` with `arg`; the label is HTML already (icons), the rest is escaped.

    Args:
        label: HTML.
        do: name of the action.
        arg: handed to the action.
        title: shown when the pointer rests.
        on: whether it is on.
        disabled: whether it cannot be used now.
    """
    attributes = f'type="button" data-do="{text(do)}" data-arg="{text(arg)}" title="{text(title)}"'
    return f'<button class="{"on" if on else ""}" {attributes} {"disabled" if disabled else ""}>{label}</button>'


def switch(name: str, hint: str, arg: object, *, on: bool = False, disabled: bool = False) -> str:
    """A name with its explanation that is switched on and off; a click is the action `switch` with `arg`.

    Args:
        name: shown.
        hint: its explanation.
        arg: handed to the action.
        on: whether it is on.
        disabled: whether it cannot be used now.
    """
    attributes = f'type="button" role="switch" aria-checked="{str(on).lower()}" aria-label="{text(name)}"'
    attributes += f' title="{text(hint)}" data-do="switch" data-arg="{text(arg)}" {"disabled" if disabled else ""}'
    return f'<button class="switch" {attributes}><i></i><span>{text(name)}<small>{text(hint)}</small></span></button>'


def _read_actions(value: str) -> list[tuple[int, Action]]:
    """The page's latest actions with their numbers: a message that overtakes another repeats what that one said."""
    try:
        said = clean_strings(json.loads(value))
        return [(int(m["number"]), Action(str(m["do"]), str(m["arg"]), bool(m["add"]))) for m in said]
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
        return []  # typed by hand, or by a page that is not ours
