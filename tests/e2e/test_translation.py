"""In a language where every text of the table is in ⟦brackets⟧, the page shows none without."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po
from playwright.sync_api import BrowserContext, expect

from diorama_app.serve import start
from diorama_app.session.preferences import Preferences
from diorama_app.strings import use_language
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture
from tests.review.doubtful_room import doubtful_scene

pytestmark = [pytest.mark.browser, pytest.mark.slow]

TABLE = Path(__file__).resolve().parents[2] / "diorama_app" / "strings" / "diorama.pot"
NO_TEXT = (
    *("Diorama", "Ctrl", "Shift", "Alt", "Esc", "Del", "Backspace", "Space", "cm", "ft-in", "kg", "MB", "GB", "kB"),
    *("Meshopt", "Draco", "PNG", "JPEG", "User 1"),
)
"""Names, keys, units and formats."""
UNTRANSLATED = """(known) => {
    const stripped = (text) => {
        for (let before = ""; before !== text;) { before = text; text = text.replace(/⟦[^⟦⟧]*⟧/g, " "); }
        for (const name of known) text = text.replaceAll(name, " ");
        return text.replace(/\\.[a-z0-9]+/g, " ");
    };
    const found = new Set();
    const look = (text, where) => {
        if (/\\p{L}{2}/u.test(stripped(text ?? ""))) found.add(`${where}: ${text.trim()}`);
    };
    for (const node of document.body.querySelectorAll("*")) {
        if (node.closest("script, style, [lang=en]") || !node.checkVisibility({ visibilityProperty: true })) continue;
        const text = [...node.childNodes].some((child) => child.nodeType === Node.TEXT_NODE);
        if (text) look(node.closest(":not(b, span)").textContent, node.tagName); // a text may have bold words
        for (const name of ["title", "aria-label", "placeholder", "alt"]) look(node.getAttribute(name), name);
    }
    return [...found];
}"""


def write_pseudo_language(path: Path, longer: float = 0.0) -> None:
    """A translation of every text of the table: itself in brackets, and longer by a share of its length."""
    with TABLE.open("rb") as file:
        catalogue = read_po(file, locale="de")
    for message in catalogue:
        if message.id:
            texts = (message.id,) if isinstance(message.id, str) else message.id
            wrapped = tuple(f"⟦{text}{'·' * round(longer * len(text))}⟧" for text in texts)
            message.string = wrapped[0] if isinstance(message.id, str) else wrapped
    with path.open("wb") as file:
        write_mo(file, catalogue)


@pytest.fixture
def foreign(context: BrowserContext, tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[EditorPage]:
    table = tmp_path / "pseudo.mo"
    write_pseudo_language(table)
    project = make_project(tmp_path / "projects" / "demo")
    running = start(
        project=project.folder,
        projects_dir=tmp_path / "projects",
        low_graphics=True,
        library=PlainLibrary(),
        language=str(table),
    )
    page = EditorPage.open(context, running)
    yield page
    keep_picture(page, request.node.name)
    page.page.close()
    running.stop()
    use_language("en")
    assert not page.errors, page.errors


def untranslated(editor: EditorPage, where: str) -> set[str]:
    """What is shown without brackets, but for names of objects, kinds of files and the like."""
    editor.settle()
    editor.page.wait_for_timeout(400)  # the page names fields five times a second
    session = editor.session
    captions = (shape.caption for shape in session.library.shapes())
    objects = (*session.scene.objects, *furnished_scene().objects)
    labels = [*(o.label for o in objects), *captions, "demo", "room.png", *NO_TEXT]
    known = [
        form for label in sorted(filter(None, labels), key=len, reverse=True) for form in (label, label.capitalize())
    ]
    return {f"{where}: {line}" for line in editor.page.evaluate(UNTRANSLATED, known)}


def test_no_text_of_the_page_is_without_a_translation(foreign: EditorPage) -> None:
    page, session, found = foreign.page, foreign.session, set[str]()

    def look(where: str) -> None:
        found.update(untranslated(foreign, where))

    def act(do: str, arg: str | None = None) -> None:
        which = f'[data-do="{do}"]' + ("" if arg is None else f'[data-arg="{arg}"]')
        page.locator(f"{which}:visible").first.click()

    session.ui_thread.ask(lambda: foreign.client.take_preferences(Preferences(numbers=True, physics=True)))
    look("nothing selected")
    foreign.row("lamp").click()
    foreign.until(lambda: foreign.selection == ("lamp_1",))
    for tab in ("Scene", "Photo", "Arrange", "Project", "Object", "Library", "Export"):
        foreign.tab(f"⟦{tab}⟧")
        for folder in page.locator("summary:visible").all():
            folder.click()
        look(tab)
    foreign.tab("⟦Scene⟧")
    foreign.tab("⟦Object⟧")
    for folder in ("Room", "Light"):
        page.get_by_text(f"⟦{folder}⟧", exact=True).first.click()
    act("day")
    look("room and light")
    act("surface", "wall_3")
    foreign.until(lambda: foreign.client.surface == "wall_3")
    act("pattern", "stripes")
    foreign.until(lambda: session.scene.plane("wall_3").finish is not None)
    look("surface")
    act("run", "undo")
    look("undone")
    session.ui_thread.ask(lambda: session.commit("⟦doubt⟧", replace(doubtful_scene(), scale_sigma=0.3)))
    act("review")
    expect(page.locator(".review")).to_be_visible()
    look("review")
    page.locator('.review [data-do="close"]').click()
    act("run", "view_plan")
    expect(page.locator("#dio-plan svg")).to_be_visible()
    page.locator("[data-menu]").click()
    look("plan and menu")
    page.keyboard.press("Escape")
    act("run", "view_room")
    page.keyboard.press("m")
    look("measuring")
    page.keyboard.press("Escape")
    page.keyboard.press("i")
    look("picture")
    page.keyboard.press("Escape")
    page.keyboard.press("?")
    look("help")
    page.keyboard.press("Escape")
    foreign.tab("⟦Project⟧")
    page.get_by_role("button", name="⟦All projects⟧", exact=True).click()
    expect(page.locator(".page:visible")).to_be_visible()
    look("all projects")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="⟦Start page⟧", exact=True).click()
    expect(page.locator("#dio-start")).to_be_visible()
    look("start page")
    act("tour")
    for _ in range(6):
        look("tour")
        page.locator("#dio-tour .main").click()
    foreign.tab("⟦Photo⟧")
    act("board")
    foreign.at_board()
    foreign.draw_box((100.0, 100.0, 200.0, 300.0))
    foreign.until(lambda: foreign.client.selected_box is not None)
    look("marking")
    act("build")
    foreign.until(lambda: session.jobs.status is not None)
    look("building")
    foreign.until(lambda: session.jobs.status is None, "built", seconds=240.0)
    look("built")
    assert not found, "\n".join(sorted(found))
