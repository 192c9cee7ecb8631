"""The table of the page's texts is complete; a translation replaces them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo

from diorama_app.strings import N_, _, language, plural, translate_script, use_language
from diorama_core.errors import InputError
from scripts import strings as script

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def german(tmp_path: Path) -> Iterator[Path]:
    catalogue = Catalog(locale="de")
    catalogue.add("Delete {name}", "{name} löschen")
    catalogue.add(("{count} object", "{count} objects"), ("{count} Objekt", "{count} Objekte"))
    catalogue.add("Close", "Zu</script>")
    path = tmp_path / "german.mo"
    with path.open("wb") as file:
        write_mo(file, catalogue)
    yield path
    use_language("en")


def test_the_table_is_up_to_date() -> None:
    assert script.TABLE.read_bytes() == script.table(), "run python scripts/strings.py"


def test_what_is_marked_is_found() -> None:
    code = """
MANY = ("{count} box", "{count} boxes")
label = _("a") if x else N_("b")
plural("{count} hit", "{count} hits", n), plural(*MANY, n), _(variable), _(f"no {constant}")
raise EditRefused("first" if x else "second")
"""
    found = {"a", "b", ("{count} hit", "{count} hits"), ("{count} box", "{count} boxes"), "first", "second"}
    assert set(script.texts_in(code)) == found


def test_texts_are_translated_and_others_stay(german: Path) -> None:
    use_language(str(german))
    assert language() == "de"
    assert _("Delete {name}").format(name="Stuhl") == "Stuhl löschen"
    assert [plural("{count} object", "{count} objects", n) for n in (1, 3)] == ["1 Objekt", "3 Objekte"]
    assert (_("unknown"), _(""), N_("Close")) == ("unknown", "", "Close")
    use_language("en")
    assert (language(), _("Close"), plural("{count} object", "{count} objects", 0)) == ("en", "Close", "0 objects")


def test_a_script_gets_its_texts_and_does_not_end_by_them(german: Path) -> None:
    use_language(str(german))
    script = 'x = _("Close"); y = __("Close"); z = _("Delete " +\n  "{name}");'
    assert translate_script(script) == 'x = "Zu<\\/script>"; y = __("Close"); z = "{name} löschen";'


def test_no_such_language_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "broken.mo").write_bytes(b"no table")
    for wrong, words in (("xx", "choose en"), (str(tmp_path / "broken.mo"), "pybabel"), ("gone.mo", "not a readable")):
        with pytest.raises(InputError, match=words):
            use_language(wrong)
    assert language() == "en"
