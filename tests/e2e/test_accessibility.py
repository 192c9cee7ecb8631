"""Every panel in light and dark: axe-core finds nothing serious; rows are reached and used by keys."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import expect

from diorama_core.review.questions import questions
from tests.e2e.browser import EditorPage
from tests.review.doubtful_room import doubtful_scene

pytestmark = [pytest.mark.browser, pytest.mark.slow]

AXE = Path(__file__).resolve().parents[2] / ".venv" / "node" / "node_modules" / "axe-core" / "axe.min.js"
needs_axe = pytest.mark.skipif(
    not AXE.exists(), reason="axe-core is missing: npm install --prefix .venv/node axe-core@4.10.3"
)
ALL_RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]
OF_COLOURS = ["color-contrast"]
"""In the dark the page is the same but for these."""
FINDINGS = """async (rules) => {
    const fading = document.getAnimations().filter((a) => a.animationName === "dio-fade");
    fading.forEach((a) => { a.pause(); a.currentTime = 0; });
    const seen = (window.__axeSeen ??= new Set()), known = [], fresh = [];
    const walk = (e, above) => {
        const html = above + e.outerHTML, within = html.slice(0, html.length - e.innerHTML.length);
        if (seen.has(html)) known.push(e);
        else { fresh.push(html); [...e.children].forEach((child) => walk(child, within)); }
    };
    walk(document.body, document.documentElement.className);
    const options = { runOnly: rules, resultTypes: ["violations"], selectors: false };
    const found = await axe.run({ include: document, exclude: known }, options);
    fresh.forEach((html) => seen.add(html));
    fading.forEach((a) => a.finish());
    return found.violations.filter((v) => ["serious", "critical"].includes(v.impact)).flatMap((v) =>
        v.nodes.map((n) => `${v.id}: ${n.html.slice(0, 160)} ${(n.any[0] || {}).message || ""}`));
}"""
"""A message that fades is looked at as it came: half faded words have another contrast than the ones to be read.
What was looked at before and is the same, within the same, is left out: most of a page, from one tab to the next."""
TABS = ("Scene", "Photo", "Arrange", "Project", "Object", "Library", "Export")


NAMED = """() => [...document.querySelectorAll('.mantine-Flex-root label[for]')].every((label) =>
    [...label.closest('.mantine-Flex-root').querySelectorAll('input:not([type=hidden]), textarea, [role=slider]')]
        .every((field) => field.hasAttribute('aria-label')))"""
"""The page gives the fields of a tab that was just opened their names five times a second."""


def findings(editor: EditorPage, rules: list[str]) -> list[str]:
    editor.settle()
    editor.page.wait_for_function(NAMED)
    found: list[str] = editor.page.evaluate(FINDINGS, rules)
    return found


@needs_axe
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_axe_finds_nothing_serious_in_any_panel(editor: EditorPage, dark: bool) -> None:
    if dark:
        editor.menu_tool("Dark or light").click()
        editor.page.wait_for_function("document.documentElement.dataset.mantineColorScheme === 'dark'")
    rules = OF_COLOURS if dark else ALL_RULES
    editor.page.add_script_tag(path=str(AXE))
    editor.row("lamp").click()
    editor.until(lambda: editor.selection == ("lamp_1",))
    found: set[str] = set()
    for tab in TABS:
        editor.tab(tab)
        found |= {f"{tab}: {line}" for line in findings(editor, rules)}
    for tab in ("Scene", "Object"):
        editor.tab(tab)
    session = editor.session
    known, boxes = doubtful_scene(), {"chair_1": (50.0, 100.0, 150.0, 400.0)}
    seen = tuple(replace(o, box_px=boxes.get(o.id)) for o in known.objects)
    session.ui_thread.ask(lambda: session.commit("doubt", replace(known, objects=seen, scale_sigma=0.3)))
    card = editor.page.locator(".job.card", has_text="sure")
    expect(card).to_be_visible()
    found |= {f"how sure it is: {line}" for line in findings(editor, rules)}
    card.get_by_role("button", name="Review").click()
    for question in questions(session.scene)[:4]:
        expect(editor.page.locator(".review")).to_contain_text(question.sentence)
        found |= {f"review: {line}" for line in findings(editor, rules)}
        editor.page.locator(".review").get_by_role("button", name="Later").click()
    editor.page.locator(".review").get_by_role("button", name="Close").click()
    editor.page.locator(".dio .row:visible", has_text="Wall 3").first.click()
    editor.page.locator(".dio .tile:visible", has_text="Stripes").click()
    editor.until(lambda: editor.session.scene.plane("wall_3").finish is not None)
    found |= {f"surface: {line}" for line in findings(editor, rules)}
    editor.tab("Project")
    editor.button("Start page").click()
    expect(editor.page.locator("#dio-start")).to_be_visible()
    found |= {f"start page: {line}" for line in findings(editor, rules)}
    editor.page.locator("#dio-start [data-do=tour]").click()
    expect(editor.page.locator("#dio-tour")).to_be_visible()
    found |= {f"tour: {line}" for line in findings(editor, rules)}
    editor.page.locator("#dio-tour .skip").click()
    editor.tool("Plan").click()
    expect(editor.page.locator("#dio-plan svg")).to_be_visible()
    editor.tool("More tools").click()
    found |= {f"plan and menu: {line}" for line in findings(editor, rules)}
    editor.page.keyboard.press("Escape")
    editor.tool("Room").click()
    editor.tab("Photo")
    editor.button("Continue marking").click()
    editor.at_board()
    found |= {f"photo: {line}" for line in findings(editor, rules)}
    if dark:
        editor.menu_tool("Dark or light").click()
    assert not found, "\n".join(sorted(found))


def test_rows_are_used_by_keys(editor: EditorPage) -> None:
    scene = editor.session.scene
    editor.page.locator(".dio .row[data-grab]").first.focus()
    rows = [row.get_attribute("data-arg") for row in editor.page.locator(".dio .row[data-grab]").all()]
    editor.page.keyboard.press("ArrowDown")
    editor.page.keyboard.press("ArrowDown")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: editor.selection == (rows[2],), "the third row is selected")
    editor.settle()
    editor.page.wait_for_function("document.activeElement.matches('.dio .row.on')")
    editor.page.keyboard.press("ArrowUp")
    editor.page.keyboard.press("Space")
    editor.until(lambda: editor.selection == (rows[1],), "the second")
    editor.settle()
    editor.page.wait_for_function("document.activeElement.matches('.dio .row.on')")
    editor.page.keyboard.press("F2")
    field = editor.page.locator(".dio .row input")
    expect(field).to_be_focused()
    field.fill("renamed by keys")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: editor.session.scene.object(rows[1]).label == "renamed by keys", "renamed")
    editor.settle()
    editor.page.wait_for_function("document.activeElement.matches('.dio .row')")
    editor.page.keyboard.press("ArrowUp")
    editor.page.keyboard.press("Enter")
    editor.until(lambda: editor.selection == (rows[0],), "the keys go on from the renamed row")
    assert editor.session.scene is not scene


def test_names_are_in_the_labels_of_lock_and_hide(editor: EditorPage) -> None:
    expect(editor.page.get_by_role("button", name="Hide lamp", exact=True)).to_be_visible()
    expect(editor.page.get_by_role("button", name="Lock lamp", exact=True)).to_be_visible()
