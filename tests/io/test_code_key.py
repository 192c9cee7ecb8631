"""Keys of code: an edit of what a module uses changes its key, an edit elsewhere does not."""

from __future__ import annotations

import time

import pytest

from diorama_core.io.code_key import Sources, code_key, package_sources

FILES = {
    "__init__.py": "",
    "stage.py": "from diorama_core.helpers import (\n    near,\n)\n\ndef run():\n    import diorama_core.late\n",
    "helpers/__init__.py": "from diorama_core.helpers.near import near\n",
    "helpers/near.py": "from diorama_core import stage\n\n\ndef near():\n    return stage\n",
    "late.py": "LIMIT = 3\n",
    "other.py": "LIMIT = 4\n",
}


@pytest.fixture
def package(tmp_path):
    for name, text in FILES.items():
        path = tmp_path / "diorama_core" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def digests(root) -> dict[str, str]:
    sources = Sources(root)
    return {name: sources.digest(name) for name in sources.closure("diorama_core.stage")}


def test_a_module_uses_what_it_imports_directly_or_not_and_within_functions(package):
    used = {name.removeprefix("diorama_core.") for name in digests(package)}
    assert used == {"diorama_core", "stage", "helpers", "helpers.near", "late"}


@pytest.mark.parametrize(("edited", "changes"), [("helpers/near.py", True), ("late.py", True), ("other.py", False)])
def test_an_edit_counts_where_it_is_used(package, edited, changes):
    before = digests(package)
    path = package / "diorama_core" / edited
    path.write_text(path.read_text() + "\nADDED = 1\n")
    assert (digests(package) != before) is changes


def test_modules_elsewhere_are_named_by_themselves():
    assert not package_sources().closure("json")
    assert code_key("json") != code_key("math")


def test_designs_of_furniture_do_not_count():
    used = package_sources().closure("diorama_core.library.catalogue")
    assert not any(name.startswith("diorama_core.library.furniture.") for name in used)


@pytest.mark.unchecked
def test_it_costs_little():
    sources, began = Sources(package_sources()._root), time.process_time()
    used = sources.closure("diorama_core.pipeline.stages")
    assert [sources.digest(name) for name in used]
    assert time.process_time() - began < 0.5  # 0.05 on a free machine
