"""A hand at mouse and keyboard that counts: every click, every drag, every key and every chosen file is one action."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from playwright.sync_api import Locator

from tests.e2e.browser import EditorPage


@dataclass
class Hand:
    """Does what a person does, and writes it down."""

    editor: EditorPage
    actions: list[str] = field(default_factory=list)

    @property
    def count(self) -> int:
        """How many actions there were."""
        return len(self.actions)

    def click(self, target: Locator | tuple[float, float], what: str) -> None:
        """One click, on something of the page or at a place of it."""
        if isinstance(target, tuple):
            self.editor.page.mouse.move(*target)
            self.editor.settle()
            self.editor.page.mouse.click(*target)
        else:
            target.click()
        self.actions.append(f"click {what}")

    def drag(self, start: tuple[float, float], end: tuple[float, float], what: str) -> None:
        """One drag with the left button."""
        self.editor.drag(start, end)
        self.actions.append(f"drag {what}")

    def key(self, key: str, what: str) -> None:
        """One key."""
        self.editor.page.keyboard.press(key)
        self.actions.append(f"press {key}: {what}")

    def write(self, words: str) -> None:
        """Every letter is an action."""
        for letter in words:
            self.editor.page.keyboard.type(letter)
            self.actions.append(f"type {letter!r}")

    def choose_file(self, button: Locator, path: Path) -> None:
        """A click on the button, and one on the file in the browser's dialog."""
        with self.editor.page.expect_file_chooser() as chosen:
            button.click()
        chosen.value.set_files(str(path))
        self.actions += ["click to choose a file", f"choose {path.name}"]

    def save(self, path: Path) -> None:
        """Write the journey down, an action a line."""
        path.parent.mkdir(parents=True, exist_ok=True)
        lines = [f"{number:3d}  {action}" for number, action in enumerate(self.actions, start=1)]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
