"""Prepares the documentation site's pages: `./scripts/docs` builds them with Sphinx into `build/site`.

    python scripts/docs_site.py FOLDER

Pages are those of `docs/`, those at the root of the repository, and the reference, whose text is the docstrings of the
public modules. Pages are written for a reader of the repository: links that leave `docs/` become the names of files.
"""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ROOT_PAGES = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
PARTS = {
    "Use": ("installing", "editor", "what-goes-in", "export", "many-photos", "library", "models", "blender"),
    "Programs": ("python", "api", "agents", "scene-file", "homes", "reference/index"),
    "Method": ("how-it-works", "architecture-reconstruction", "benchmark", "layout-benchmark", "reliability"),
    "Project": ("contributing", "adding", "style", "changelog", "licences", "editor-comparison", "translating"),
}
"""The pages in the order of the site's navigation."""
REFERENCE = {
    "interface": ("The public interface", "diorama_core"),
    "protocols": ("Stages", "diorama_core.protocols"),
    "artefacts": ("What stages exchange", "diorama_core.artefacts"),
    "scene": ("The scene", "diorama_core.scene.types"),
    "frames": ("Frames, axes and units", "diorama_core.scene.frames"),
    "library": ("Shapes", "diorama_core.library.record"),
    "progress": ("Progress", "diorama_core.progress"),
    "errors": ("Errors", "diorama_core.errors"),
}
"""Pages of docstrings: title and module."""
OUTSIDE = re.compile(r"\[([^\]]+)\]\((?:(?:\.\./)+[^)]*|examples|LICENSE)\)")


def main(target: Path) -> None:
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(ROOT / "docs", target, ignore=shutil.ignore_patterns("conf.py"))
    for name, page in ROOT_PAGES.items():
        text = (ROOT / name).read_text("utf-8").replace("](docs/", "](")
        for other, renamed in ROOT_PAGES.items():
            text = text.replace(f"]({other})", f"]({renamed})")
        (target / page).write_text(text, "utf-8")
    for page in target.rglob("*.md"):
        page.write_text(OUTSIDE.sub(r"\1", page.read_text("utf-8")), "utf-8")
    with (target / "index.md").open("a", encoding="utf-8") as index:
        index.writelines(contents(title, pages, hidden=True) for title, pages in PARTS.items())
    write_reference(target / "reference")
    for log in (target / "log").glob("*.md"):
        log.write_text("---\norphan: true\n---\n\n" + log.read_text("utf-8"), "utf-8")


def write_reference(folder: Path) -> None:
    """Write a page for each public module, and the page that lists them."""
    folder.mkdir()
    for name, (title, module) in REFERENCE.items():
        directive = f".. automodule:: {module}\n"
        if module == "diorama_core":
            directive += "   :imported-members:\n"
        (folder / f"{name}.rst").write_text(f"{title}\n{'=' * len(title)}\n\n{directive}", "utf-8")
    (folder / "index.md").write_text("# Reference\n" + contents("", tuple(REFERENCE), hidden=False), "utf-8")


def contents(title: str, pages: tuple[str, ...], hidden: bool) -> str:
    """A table of contents as MyST writes it."""
    options = (f":caption: {title}\n" if title else "") + (":hidden:\n" if hidden else "")
    return "\n```{toctree}\n" + options + "\n".join(pages) + "\n```\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
