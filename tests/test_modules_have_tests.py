"""Every module has a test of its own, or a reason not to; see `scripts/untested_modules.py`."""

from __future__ import annotations

from pathlib import Path

import pytest

from scripts import untested_modules as script

ROOT = Path(__file__).resolve().parents[1]


def test_every_module_has_a_test_or_a_reason() -> None:
    assert script.complaints(ROOT, script.untested_modules(ROOT), script.read_reasons(ROOT)) == []


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Two packages with three modules, one of which is re-exported, and no tests."""
    files = {
        "diorama_core/__init__.py": "from .solids import Box\n",
        "diorama_core/solids.py": "class Box: ...\n",
        "diorama_core/pose/__init__.py": "",
        "diorama_core/pose/turns.py": "",
        "diorama_core/library/furniture/__init__.py": "",
        "diorama_core/library/furniture/chairs.py": "",
        "diorama_app/__init__.py": "",
        "diorama_app/page.py": "",
        "tests/untested.toml": "[reasons]\n",
    }
    for name, text in files.items():
        write(tmp_path, name, text)
    return tmp_path


def write(root: Path, name: str, text: str) -> None:
    (root / name).parent.mkdir(parents=True, exist_ok=True)
    (root / name).write_text(text)


ALL = {"diorama_core.solids", "diorama_core.pose.turns", "diorama_app.page"}


def test_designs_and_packages_need_none(checkout: Path) -> None:
    assert script.modules(checkout) == script.untested_modules(checkout) == ALL


@pytest.mark.parametrize(
    ("name", "text", "tested"),
    [
        ("tests/test_a.py", "import diorama_core.solids\n", "diorama_core.solids"),
        ("tests/test_a.py", "from diorama_core import solids as s\n", "diorama_core.solids"),
        ("tests/test_a.py", "from diorama_core.solids import Box\n", "diorama_core.solids"),
        ("tests/test_a.py", "def test():\n    from diorama_core import Box\n", "diorama_core.solids"),
        ("tests/pose/test_turns.py", "", "diorama_core.pose.turns"),
        ("tests/app/test_page.py", "", "diorama_app.page"),
    ],
)
def test_importing_or_mirroring_a_module_tests_it(checkout: Path, name: str, text: str, tested: str) -> None:
    write(checkout, name, text)
    assert script.untested_modules(checkout) == ALL - {tested}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("tests/helper.py", "import diorama_core.solids\n"),
        ("tests/e2e/test_a.py", "import diorama_core.solids\n"),
        ("tests/test_a.py", "if TYPE_CHECKING:\n    import diorama_core.solids\n"),
        ("tests/test_a.py", "import diorama_core\n"),
    ],
)
def test_other_imports_do_not(checkout: Path, name: str, text: str) -> None:
    write(checkout, name, text)
    assert script.untested_modules(checkout) == ALL


def test_the_table_of_reasons_is_checked(checkout: Path) -> None:
    write(checkout, "tests/test_a.py", "import diorama_core.solids\n")
    untested = script.untested_modules(checkout)
    told = script.complaints(
        checkout, untested, {"diorama_core.solids": "why", "diorama_core.gone": "why", "diorama_app.page": " "}
    )
    assert [line.split(":")[0] for line in told] == [
        "diorama_app.page", "diorama_core.gone", "diorama_core.pose.turns", "diorama_core.solids",
    ]  # fmt: skip
    for line, why in zip(told, ("is empty", "does not exist", "no test imports it", "has a test"), strict=True):
        assert why in line
    many = {f"diorama_core.m{k}": "why" for k in range(script.MAX_REASONS + 1)}
    assert any("at most 20" in line for line in script.complaints(checkout, set(many), many))
    assert script.complaints(checkout, untested, dict.fromkeys(untested, "why")) == []
