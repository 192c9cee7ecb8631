"""The pages that `./scripts/docs` hands to Sphinx: all are in the navigation, and links stay within the site."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

from scripts import docs_site as script

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site") / "pages"
    script.main(folder)
    return folder


def test_every_page_is_in_the_navigation_once(pages: Path) -> None:
    written = {path.stem for path in pages.glob("*.md")} - {"index"} | {"reference/index"}
    assert sorted(name for part in script.PARTS.values() for name in part) == sorted(written)


def test_links_stay_within_the_site(pages: Path) -> None:
    for page in pages.rglob("*.md"):
        for target in re.findall(r"\]\((?!\w+:|#)([^)#\s]+)", page.read_text("utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_reference_is_of_modules_that_exist() -> None:
    assert all(import_module(module).__doc__ for _, module in script.REFERENCE.values())
