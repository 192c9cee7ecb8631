"""Objaverse-LVIS, ShapeNetCore, HSSD, 3D-FUTURE and ABO: where their files lie and what their metadata means.

They are read from a local copy in the layout in which they are distributed: nothing is downloaded, and each licence
stays what it is. Taking the models in is the same as for anyone's own.
"""

from __future__ import annotations

import csv
import gzip
import io
import re
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import megabytes, parse_json, read_bytes
from diorama_core.library import taxonomy
from diorama_core.library.ingest.finding import sources
from diorama_core.library.ingest.given import AXES, Given
from diorama_core.library.ingest.shaping import ModelSource

MAX_METADATA_BYTES = 600_000_000
"""Bytes of one file of a data set, unpacked; the largest published ones have a tenth of it."""
_ADVICE = "download it again"


@dataclass(frozen=True)
class DatasetEntry:
    """One model of a data set."""

    path: Path
    id: str
    words: tuple[str, ...]
    """What the data set calls it, the most telling first: 'dining chair', 'Chair/Stool'."""
    given: Given
    """Axes and unit, licence and caption; the category follows from the words."""


@dataclass(frozen=True)
class Dataset:
    """How one data set is laid out."""

    name: str
    marks: tuple[str, ...]
    """Files or folders (patterns) of its layout; a folder that has one of them is taken for it."""
    entries: Callable[[Path], Iterator[DatasetEntry]]
    """Its models under a folder, in a stable order; those whose files are absent are left out."""


def as_sources(dataset: Dataset, folder: Path, given: Given) -> tuple[ModelSource, ...]:
    """The models of a local copy, ready to be taken in; `given` (flags of the user) goes before what the set says.

    Raises:
        InputError: when no model is found, or its metadata cannot be read.
    """
    entries = list(dataset.entries(folder))
    if not entries:
        raise InputError(f"{folder}: no model of {dataset.name} lies there; name the folder that it was unpacked to")
    known = {e.path.relative_to(folder).as_posix(): given.override(_categorise(e, dataset)) for e in entries}
    ids = {e.path: e.id for e in entries}
    return sources(folder, [e.path for e in entries], Given(), known, ids)


def _categorise(entry: DatasetEntry, dataset: Dataset) -> Given:
    """What the set says, with the category that its words mean; its own words become synonyms."""
    category = next((c for w in entry.words for c in [taxonomy.resolve(w)] if w and c.exact), None)
    name = category.category.name if category is not None else taxonomy.UNKNOWN.name
    words = tuple(dict.fromkeys(w.lower() for w in entry.words if w and w.lower() != name))
    caption = entry.given.caption or (words[0] if words else name)
    return replace(
        entry.given,
        category=name if entry.words else None,
        caption=caption,
        synonyms=words,
        source=dataset.name,
        reason=dataset.name,
    )


def read_json(path: Path) -> Any:
    """A JSON file, gzipped or not; raises `InputError` when it cannot be read."""
    return json_from(path, read_text(path))


def json_from(path: Path, text: str) -> Any:
    """JSON out of a file's text; raises `InputError` naming the file."""
    return parse_json(text, str(path), InputError, advice=_ADVICE, finite=False)


def read_text(path: Path) -> str:
    """A text file, gzipped or not; raises `InputError` when it cannot be read."""
    data = read_bytes(path, MAX_METADATA_BYTES, InputError, _ADVICE)
    try:
        return (_unzip(data) if path.suffix == ".gz" else data).decode("utf-8-sig")
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise InputError(f"{path} cannot be read ({error}); {_ADVICE}") from error


def _unzip(data: bytes) -> bytes:
    """The content of a gzip file, of at most `MAX_METADATA_BYTES`."""
    with gzip.GzipFile(fileobj=io.BytesIO(data)) as stream:
        content = stream.read(MAX_METADATA_BYTES + 1)
    if len(content) > MAX_METADATA_BYTES:
        raise ValueError(f"it would unpack to more than {megabytes(MAX_METADATA_BYTES)}")
    return content


def read_rows(path: Path) -> list[dict[str, str]]:
    """A CSV, gzipped or not, with its first line as names (lower case)."""
    rows = csv.reader(read_text(path).splitlines())
    names = [name.strip().lower() for name in next(rows, [])]
    return [dict(zip(names, (value.strip() for value in row), strict=False)) for row in rows if row]


def first(folder: Path, *patterns: str) -> Path | None:
    """The first file that a pattern finds."""
    return next((p for pattern in patterns for p in sorted(folder.glob(pattern))), None)


def plain_words(word: str) -> str:
    """`coffee_table`, `KITCHEN_STOOL` and `Lounge Chair / Cafe Chair` as people say it."""
    return " ".join(word.replace("_", " ").split("/")[0].split("(")[0].lower().split())


def _objaverse(root: Path) -> Iterator[DatasetEntry]:
    """`lvis-annotations.json.gz` (class -> uids), `glbs/*/UID.glb`, `metadata/*.json.gz` (uid -> name, license)."""
    notes = first(root, "lvis-annotations.json*")
    classes: dict[str, str] = {}
    if notes is not None:
        classes = {uid: name for name, uids in sorted(read_json(notes).items()) for uid in uids}
    about: dict[str, Any] = {}
    for path in sorted((root / "metadata").glob("*.json*")):
        about |= read_json(path)
    for path in sorted(root.glob("glbs/*/*.glb")):
        uid = path.stem
        if notes is not None and uid not in classes:
            continue
        row = about.get(uid, {})
        words = (plain_words(classes[uid]),) if uid in classes else ()
        licence = str(row.get("license") or "see the model's page")
        yield DatasetEntry(path, uid, words, Given(up="+y", caption=str(row.get("name") or ""), licence=licence))


def _shapenet(root: Path) -> Iterator[DatasetEntry]:
    """`SYNSET/MODEL/models/model_normalized.obj` (version 2) or `SYNSET/MODEL/model.obj` (version 1), `taxonomy.json`.

    Aligned: +Y up; front -Z in version 2. Sizes are normalised, so the unit is left to be guessed.
    """
    described = first(root, "taxonomy.json")
    names = {row["synsetId"]: row["name"] for row in read_json(described)} if described is not None else {}
    for pattern in ("*/*/models/model_normalized.obj", "*/*/model.obj"):
        for path in sorted(root.glob(pattern)):
            synset, model = path.relative_to(root).parts[:2]
            if not re.fullmatch(r"\d{8}", synset):
                continue
            words = tuple(plain_words(w) for w in names.get(synset, _SHAPENET.get(synset, "")).split(",") if w)
            front = "-z" if path.name == "model_normalized.obj" else None
            yield DatasetEntry(
                path, f"{synset}-{model}", words, Given(up="+y", front=front, licence="ShapeNet terms of use")
            )


_SHAPENET = {
    "02747177": "trash can", "02773838": "bag", "02801938": "basket", "02808440": "bathtub", "02818832": "bed",
    "02828884": "bench", "02843684": "birdhouse", "02871439": "bookshelf", "02876657": "bottle", "02880940": "bowl",
    "02933112": "cabinet", "02946921": "can", "03001627": "chair", "03046257": "clock", "03085013": "keyboard",
    "03207941": "dishwasher", "03211117": "monitor", "03325088": "faucet", "03337140": "filing cabinet",
    "03593526": "jar", "03624134": "knife", "03636649": "lamp", "03642806": "laptop", "03691459": "speaker",
    "03761084": "microwave", "03797390": "mug", "03928116": "piano", "03938244": "pillow", "03991062": "plant",
    "04004475": "printer", "04074963": "remote control", "04256520": "sofa", "04330267": "stove", "04379243": "table",
    "04401088": "telephone", "04460130": "tower", "04554684": "washing machine",
}  # fmt: skip
"""WordNet numbers of the classes that are found in rooms, for copies without `taxonomy.json`."""


def _hssd(root: Path) -> Iterator[DatasetEntry]:
    """`objects/*/HASH.glb` with `HASH.object_config.json` beside it, and a table of names in `metadata` or `semantics`.

    Parts of objects (`*_part_*`), colliders and filtered copies are left out.
    """
    about: dict[str, dict[str, str]] = {}
    for path in sorted([*root.glob("metadata/*.csv"), *root.glob("semantics/*.csv")]):
        for row in read_rows(path):
            key = next((row[k] for k in ("id", "object hash", "object_id", "hash") if row.get(k)), "")
            about.setdefault(key, {}).update({k: v for k, v in row.items() if v})
    for path in sorted(root.glob("objects/**/*.glb")):
        if "_part_" in path.stem or ".collider" in path.name or ".filteredSupportSurface" in path.name:
            continue
        row = about.get(path.stem, {})
        config = path.with_suffix(".object_config.json")
        stated = read_json(config) if config.is_file() else {}
        columns = ("main_category", "clean_category", "category", "wnlemmas", "super_category")
        words = tuple(plain_words(w) for c in columns for w in row.get(c, "").split(",") if w)
        up, front = (_axis(stated.get(name) or row.get(name)) for name in ("up", "front"))
        front = None if front is not None and up is not None and front[1] == up[1] else front
        caption = row.get("name", "")
        yield DatasetEntry(
            path,
            path.stem,
            words,
            Given(up=up or "+y", front=front, unit_m=1.0, caption=caption, licence="CC BY-NC 4.0"),
        )


def _future(root: Path) -> Iterator[DatasetEntry]:
    """`MODEL/raw_model.obj` (metres, +Y up, +Z front) and `model_info.json` (model_id, super-category, category...)."""
    info = first(root, "model_info.json", "*/model_info.json")
    about = {row["model_id"]: row for row in read_json(info)} if info is not None else {}
    for path in sorted(root.glob("**/raw_model.obj")):
        row = about.get(path.parent.name, {})
        words = tuple(plain_words(str(row[k])) for k in ("category", "super-category") if row.get(k))
        details = [str(row[k]).lower() for k in ("style", "material") if row.get(k)]
        caption = ", ".join([*words[:1], *details])
        licence = "Tianchi 3D-FUTURE terms of use"
        yield DatasetEntry(path, path.parent.name, words, Given("+y", "+z", 1.0, caption=caption, licence=licence))


def _abo(root: Path) -> Iterator[DatasetEntry]:
    """`3dmodels/original/*/ID.glb` (metres, +Y up, +Z front); `listings/metadata/listings_*.json.gz`, one a line."""
    about: dict[str, tuple[str, str]] = {}
    for path in sorted(root.glob("listings/metadata/listings_*.json*")):
        for line in read_text(path).splitlines():
            row = json_from(path, line) if line.strip() else {}
            if row.get("3dmodel_id"):
                kind = next((str(v.get("value", "")) for v in row.get("product_type", [])), "")
                about[row["3dmodel_id"]] = (plain_words(kind), _english(row.get("item_name", [])))
    for path in sorted(root.glob("3dmodels/original/*/*.glb")):
        kind, name = about.get(path.stem, ("", ""))
        words = tuple(w for w in (kind, plain_words(name.split(",")[0])) if w)
        yield DatasetEntry(path, path.stem, words, Given("+y", "+z", 1.0, caption=name[:120], licence="CC BY 4.0"))


def _english(names: list[dict[str, str]]) -> str:
    ranked = sorted(names, key=lambda n: not str(n.get("language_tag", "")).startswith("en"))
    return str(ranked[0].get("value", "")) if ranked else ""


def _axis(value: object) -> str | None:
    """`[0, 1, 0]`, `0,1,0`, `0\\,1\\,0` or `+Y` as `+y`; None when it is no axis."""
    if isinstance(value, str):
        text = value.strip().lower()
        if text in AXES:
            return text
        value = [part for part in re.split(r"[^0-9.eE+-]+", text) if part]
    if not isinstance(value, list) or len(value) != 3:
        return None
    try:
        numbers = [float(v) for v in value]
    except (TypeError, ValueError):
        return None
    largest = max(range(3), key=lambda k: abs(numbers[k]))
    rest = sum(abs(n) for n in numbers) - abs(numbers[largest])
    if abs(numbers[largest]) < 1e-6 or rest > 0.1 * abs(numbers[largest]):
        return None
    return ("+" if numbers[largest] > 0 else "-") + "xyz"[largest]


DATASETS: tuple[Dataset, ...] = (
    Dataset("objaverse-lvis", ("lvis-annotations.json*", "glbs"), _objaverse),
    Dataset("shapenetcore", ("[0-9]" * 8 + "/*/models/model_normalized.obj", "[0-9]" * 8 + "/*/model.obj"), _shapenet),
    Dataset("hssd", ("objects/**/*.object_config.json",), _hssd),
    Dataset("3d-future", ("model_info.json", "*/raw_model.obj", "*/model_info.json"), _future),
    Dataset("abo", ("3dmodels/original", "listings/metadata"), _abo),
)


def dataset_named(name: str) -> Dataset:
    """The data set of that name; raises `InputError` when there is none."""
    dataset = next((d for d in DATASETS if d.name == name.lower()), None)
    if dataset is None:
        raise InputError(f"data set {name!r} is not known; choose one of {', '.join(d.name for d in DATASETS)}")
    return dataset


def recognise(folder: Path) -> Dataset | None:
    """The data set whose layout a folder has; None for a folder of anyone's models."""
    return next((d for d in DATASETS if first(folder, *d.marks) is not None), None)
