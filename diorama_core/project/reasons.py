"""Why objects are where and what they are, as a project keeps it: `reasons.json`, strongest first for each object."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from diorama_core.arrangement.explain import strength
from diorama_core.artefacts import Reason
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_json
from diorama_core.project.storage import Project

FORMAT, VERSION = "diorama-reasons", 1
NAME = "reasons.json"
_REASONS = TypeAdapter(dict[str, list[Reason]])


def reasons_document(reasons: Sequence[Reason]) -> dict[str, Any]:
    """The reasons by object, strongest first, as JSON values; `docs/scene-file.md` describes them."""
    objects: dict[str, list[dict[str, Any]]] = {}
    for reason in sorted(reasons, key=strength, reverse=True):
        row = {**asdict(reason), "amount": round(reason.amount, 3)}
        objects.setdefault(row.pop("object_id"), []).append(row)
    order = dict.fromkeys(reason.object_id for reason in reasons)
    return {"format": FORMAT, "version": VERSION, "objects": {name: objects[name] for name in order}}


def write_reasons(path: Path, reasons: Sequence[Reason], error: type[DioramaError] = ProjectError) -> None:
    """Write the reasons as a JSON file; raises `error` where that cannot be written."""
    text = json.dumps(reasons_document(reasons), indent=1, ensure_ascii=False)
    write_atomically(path, text.encode(), error=error)


def save_reasons(project: Project, reasons: Sequence[Reason]) -> None:
    """Keep the reasons of a build in its project."""
    write_reasons(project.folder / NAME, reasons)


def load_reasons(project: Project) -> tuple[tuple[Reason, ...], str]:
    """The reasons that a build left, none where none did, and what is wrong with their file, in one line."""
    path = project.folder / NAME
    if not path.exists():
        return (), ""
    try:
        document = read_json(path, ProjectError, advice="build the scene again")
        if not isinstance(document, dict) or document.get("format") != FORMAT or document.get("version") != VERSION:
            return (), f"{path} is no list of reasons of version {VERSION}; build the scene again"
        rows = document.get("objects", {})
        named = {k: [{**row, "object_id": k} for row in of_one] for k, of_one in rows.items()}
        reasons = _REASONS.validate_python(named)
    except ProjectError as error:
        return (), str(error)
    except (ValidationError, TypeError, AttributeError):
        return (), f"{path} is damaged: reasons are not told; build the scene again"
    return tuple(reason for of_one in reasons.values() for reason in of_one), ""
