"""XML of annotation tools: Pascal VOC and CVAT."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from diorama_core.perception.inputs.boxes.entry import UNNAMED, BoxFile, BoxText, Corners, entries_of, picture_of
from diorama_core.perception.inputs.boxes.nested import box_of, numbers, size_of


def is_voc(text: BoxText) -> bool:
    """Objects with a `bndbox` under `annotation`."""
    return isinstance(text.document, Element) and text.document.tag == "annotation"


def read_voc(text: BoxText) -> BoxFile:
    """Boxes of Pascal VOC, whose first pixel is number 1; the bounds of polygons where there is no box."""
    boxes = []
    for index, item in enumerate(text.document.iter("object")):
        box = item.find("bndbox")
        where = f"{text.source.name}: object {index}"
        if box is not None:
            x1, y1, x2, y2 = numbers([box.findtext(k) for k in ("xmin", "ymin", "xmax", "ymax")], where)
            corners: Corners | None = (x1 - 1.0, y1 - 1.0, x2, y2)
        else:
            points = [[_number(p.findtext("x")), _number(p.findtext("y"))] for p in item.iter("pt")]
            corners = box_of({"points": points}, where)
        boxes.append((corners, (item.findtext("name") or UNNAMED)[:200], 1.0))
    size = (_number(text.document.findtext(f"size/{side}")) for side in ("width", "height"))
    return BoxFile(entries_of(boxes), size_of(*size))


def is_cvat(text: BoxText) -> bool:
    """Pictures or tracks under `annotations`."""
    root = text.document
    if not isinstance(root, Element) or root.tag != "annotations":
        return False
    return root.find("image") is not None or root.find("track") is not None


def read_cvat(text: BoxText) -> BoxFile:
    """Boxes and the bounds of polygons and polylines of the photo; of tracks, those of the first frame."""
    root = text.document
    image = image_of(root.findall("image"), text)
    figures: list[tuple[str, Element]] = []
    if image is not None:
        figures = [(f.get("label") or UNNAMED, f) for f in image]
    for track in root.findall("track"):
        first = next((f for f in track if f.get("outside") != "1"), None)
        figures += [] if first is None else [(track.get("label") or UNNAMED, first)]
    where = f"{text.source.name}: figure"
    boxes = ((_figure(figure, f"{where} {k}"), word[:200], 1.0) for k, (word, figure) in enumerate(figures))
    stated = size_of(_number(image.get("width")), _number(image.get("height"))) if image is not None else None
    size = (_number(root.findtext(f".//original_size/{side}")) for side in ("width", "height"))
    return BoxFile(entries_of(boxes), stated or size_of(*size))


def _figure(figure: Element, where: str) -> Corners | None:
    if figure.tag == "box":
        return numbers([figure.get(k) for k in ("xtl", "ytl", "xbr", "ybr")], where)
    if figure.tag == "mask":
        left, top, width, height = numbers([figure.get(k) for k in ("left", "top", "width", "height")], where)
        return left, top, left + width, top + height
    if figure.tag not in ("polygon", "polyline"):
        return None
    pairs = [p.split(",") for p in (figure.get("points") or "").split(";")]
    return box_of({"points": [[_number(p[0]), _number(p[1])] for p in pairs if len(p) == 2]}, where)


def image_of(images: list[Element], text: BoxText) -> Element | None:
    """The picture that is the photo; None where there is none."""
    return picture_of([(i.get("name"), i) for i in images], text, "CVAT file") if images else None


def _number(word: str | None) -> float | None:
    try:
        return float(word or "")
    except ValueError:
        return None
