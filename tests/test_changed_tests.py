"""Which tests `./scripts/test --fast` chooses, and that it ends in time."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(ROOT / "scripts")
    import changed_tests

    return changed_tests


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A repository with a package that takes a name from its module, and tests at several distances from it."""
    files = {
        "diorama_core/__init__.py": "",
        "diorama_core/solids/__init__.py": "from .box import Box\n",
        "diorama_core/solids/box.py": "class Box: ...\n",
        "diorama_core/other.py": "",
        "tests/helper.py": "",
        "tests/solids/test_box.py": "",
        "tests/solids/test_name.py": "from diorama_core.solids import Box\nimport diorama_core.other\n",
        "tests/test_import.py": "import diorama_core.solids.box\nimport tests.helper\n",
        "tests/test_other.py": "import diorama_core.other\n",
        "tests/e2e/test_page.py": "import diorama_core.solids.box\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    git(tmp_path, "init", "-q", "-b", "main")
    git(tmp_path, "add", ".")
    git(tmp_path, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "start")
    return tmp_path


def git(root: Path, *words: str) -> None:
    subprocess.run(["git", *words], cwd=root, check=True)


def test_changed_is_what_differs_from_main(script: ModuleType, checkout: Path) -> None:
    assert script.changed_files(checkout) == []
    git(checkout, "checkout", "-q", "-b", "work")
    (checkout / "diorama_core/other.py").write_text("x = 1\n")
    git(checkout, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-a", "-m", "change")
    (checkout / "new.md").write_text("")
    (checkout / "tests/helper.py").unlink()
    assert script.changed_files(checkout) == ["diorama_core/other.py", "new.md", "tests/helper.py"]


SOLIDS = "tests/solids/"


@pytest.mark.parametrize(
    ("changed", "tests"),
    [
        ("diorama_core/solids/box.py", [SOLIDS + "test_box.py", SOLIDS + "test_name.py", "tests/test_import.py"]),
        ("diorama_core/solids/__init__.py", [SOLIDS + "test_name.py", "tests/test_import.py"]),
        ("diorama_core/other.py", ["tests/test_other.py", SOLIDS + "test_name.py"]),
        ("tests/helper.py", ["tests/test_import.py"]),
        ("tests/test_other.py", ["tests/test_other.py"]),
        ("README.md", []),
    ],
)
def test_the_nearest_tests_come_first(script: ModuleType, checkout: Path, changed: str, tests: list[str]) -> None:
    assert list(script.select(checkout, [changed]).run) == tests


def test_tests_that_are_left_out_are_named(script: ModuleType, checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(script, "MAX_FILES", 1)
    selection = script.select(checkout, ["diorama_core/solids/box.py", "tests/e2e/test_page.py"])
    assert selection.run == ("tests/solids/test_box.py",)
    assert selection.left_out == ("tests/e2e/test_page.py", "tests/solids/test_name.py", "tests/test_import.py")
    assert "not run: tests/e2e/test_page.py" in script.summary(selection, [], 1.0)


def test_a_process_that_does_not_end_is_stopped(script: ModuleType) -> None:
    sleeping = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"], start_new_session=True)
    assert script.wait(sleeping, "tests", time.time() - script.LIMIT_S) == ["tests (stopped: 90 s are over)"]
    assert sleeping.returncode
