"""Pieces of HTML for the panels (styled by `static/panels.css`): escaped text, and a way for clicks to reach Python.

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

from diorama_app.strings import SOURCE_LANGUAGE, _, language
from diorama_app.web.viser_adapter import component_uuid
from diorama_core.io.text import clean_strings

OnAction = Callable[["Action"], None]

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
    def value(self) -> Any:
        """The argument as a JSON value, its strings cleaned; raises `ValueError` where it is none."""
        try:
            return clean_strings(json.loads(self.arg))
        except RecursionError as error:
            raise ValueError("brackets within brackets") from error

    @property
    def pair(self) -> tuple[str, str]:
        """Two words in one argument: (argument, new value) of a change, (dragged, onto) of a drop."""
        try:
            first, second = self.value
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
            field = gui.add_text("·", "", visible=False)  # the page sends its value without drawing it
            send = _SEND % component_uuid(field)
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

            async def receive(event: viser.GuiEvent[Any]) -> None:
                if event.client_id is None:
                    return
                for number, action in _read_actions(event.target.value):
                    if number > self._done:
                        self._done = number
                        on_action(action)

            field.on_update(receive)
        self._handle = gui.add_html("", visible=False)

    def show(self, body: str, *, again: bool = False) -> None:
        """Draw this HTML; nothing at all when empty. The caller escapes every name in it (`text`).

        With `again` the same HTML starts over (its animation, what was typed into it).
        """
        if body == self._body and not again:
            return
        self._body = body
        self._count += 1  # the page draws only what differs, also from what a hand has put into a field since
        mark = f"<!--{self._count}-->"
        if self._floating:
            empty = "" if body else 'data-empty="1"'
            out = f'<img alt="" src="data:," style="display:none" onerror="{_FLOAT}">'
            frame = self._frame.replace("<div ", f'<div data-float="{self._floating}" {empty} ', 1)
            self._handle.content = mark + frame.replace("%s", body + out, 1)
            self._handle.visible = True
            return
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


def library_text(english: str) -> str:
    """A line of the library as HTML: translated where it is constant, else marked as English for who reads it aloud."""
    translated = _(english)
    line = text(translated[:1].upper() + translated[1:])
    return line if translated != english or language() == SOURCE_LANGUAGE else f'<span lang="en">{line}</span>'


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


def fold_button(label: str, do: str, what: str, *, unfolded: bool) -> str:
    """A button that unfolds what is below it.

    Args:
        label: shown.
        do: name of the action.
        what: it shows and hides.
        unfolded: whether it is shown now.
    """
    sign, title = ("▾", _("Hide {content}")) if unfolded else ("▸", _("Show {content}"))
    made = button(f"{sign} {text(label)}", do, title=title.format(content=what))
    return f'<div class="bar wide">{made.replace("<button", f"<button aria-expanded={str(unfolded).lower()}")}</div>'


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
        messages = clean_strings(json.loads(value))
        return [(int(m["number"]), Action(str(m["do"]), str(m["arg"]), bool(m["add"]))) for m in messages]
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
        return []  # typed by hand, or by a page that is not ours
