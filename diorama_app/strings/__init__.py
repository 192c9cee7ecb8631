"""Texts of the page in the language of the server (`docs/translating.md`).

The table of all texts is `diorama.pot`, made by `scripts/strings.py`; a translation is a `.mo` file of GNU gettext.
"""

from __future__ import annotations

import gettext
import json
import re
from pathlib import Path

from diorama_core.errors import InputError

SOURCE_LANGUAGE = "en"
"""Language of the texts in the code."""
_QUOTED = r'"(?:[^"\\]|\\.)*"'
SCRIPT_TEXT = re.compile(rf"\b_\(({_QUOTED}(?:\s*\+\s*{_QUOTED})*)\)")
"""A text in a script of the page, in one piece or several: `_("..." + "...")`."""

_active = gettext.NullTranslations()


def use_language(language: str) -> None:
    """Show the page in another language from now on.

    Args:
        language: code of a language that has a translation here, or path of a `.mo` file.

    Raises:
        InputError: there is no such translation, or the file is none.
    """
    global _active
    here = Path(__file__).parent
    path = gettext.find("diorama", str(here), [language]) if language != SOURCE_LANGUAGE else None
    if language.endswith(".mo"):
        path = language
    elif path is None and language != SOURCE_LANGUAGE:
        known = sorted({SOURCE_LANGUAGE, *(p.parents[1].name for p in here.glob("*/LC_MESSAGES/diorama.mo"))})
        raise InputError(f"there is no translation '{language}'; choose {' or '.join(known)}, or name a .mo file")
    if path is None:
        _active = gettext.NullTranslations()
        return
    try:
        with open(path, "rb") as file:
            _active = gettext.GNUTranslations(file)
    except (OSError, ValueError) as error:
        raise InputError(f"{path} is not a readable .mo file ({error}); make it with 'pybabel compile'") from error


def language() -> str:
    """Code of the language of the page."""
    return _active.info().get("language") or SOURCE_LANGUAGE


def _(text: str) -> str:
    """A text in the language of the page; one that is not in the table stays as it is."""
    return _active.gettext(text) if text else ""


def plural(one: str, many: str, count: int) -> str:
    """A text in the grammatical number of `count`, with that number as its field `count`."""
    return _active.ngettext(one, many, count).format(count=count)


def N_(text: str) -> str:
    """A text of a constant, unchanged: `_` translates it where it is shown."""
    return text


def script_texts(script: str) -> list[str]:
    """The texts in a script of the page."""
    return [_join(match) for match in SCRIPT_TEXT.finditer(script)]


def translate_script(script: str) -> str:
    """A script with each `_("...")` replaced by the text in the language of the page."""
    # "<\\/" is "</" to a script, and does not end it to the page that holds it.
    return SCRIPT_TEXT.sub(lambda match: json.dumps(_(_join(match)), ensure_ascii=False).replace("</", r"<\/"), script)


def _join(match: re.Match[str]) -> str:
    return "".join(json.loads(piece) for piece in re.findall(_QUOTED, match[1]))
