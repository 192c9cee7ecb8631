"""Boards to write and pin on."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def whiteboard(size: Size, face: Material) -> Parts:
    """A writing board with a pen tray."""
    d, w, h = size
    return of(face, box((0.008, w - 0.02, h - 0.05), 0.001).moved(0, 0, 0.04)) + of(
        m.STEEL,
        *(s.moved(-0.004, 0, 0.03) for s in frame(0.02, w, h - 0.03, 0.014)),
        box((d, w * 0.5, 0.012), 0.004).moved(0.0, 0, 0.018),
    )


CHALK = m.art("blackboard", "clay", "#2f3a36", 0.9)


def bulletin(size: Size, bar: Material, face: Material, notes: int = 5) -> Parts:
    """A pinboard with slips of paper."""
    d, w, h = size
    parts = of(bar, *frame(d, w, h, 0.025)) + of(
        face, box((d * 0.6, w - 0.03, h - 0.03), 0.002).moved(-d * 0.2, 0, 0.015)
    )
    rng = np.random.default_rng(3)
    x = d * 0.1
    for k in range(notes):
        y = w * (0.36 - 0.72 * (k + 0.5) / notes) + float(rng.uniform(-0.03, 0.03))
        z = h * float(rng.uniform(0.34, 0.7))
        pw, ph = float(rng.uniform(0.09, 0.15)), float(rng.uniform(0.1, 0.17))
        tone = (m.PORCELAIN, m.CREAM, NOTE, NOTE_BLUE)[k % 4]
        slip = box((0.0012, pw, ph), 0.0004).moved(0, 0, -ph / 2).turned("x", float(rng.uniform(-7, 7))).moved(x, y, z)
        parts += of(tone, slip) + of(PIN, ball(0.012, 4).moved(x + 0.004, y, z + ph * 0.4))
    return parts


def letter_board(size: Size, bar: Material) -> Parts:
    """A felt board of grooves."""
    d, w, h = size
    zs = np.linspace(0.03, h - 0.04, int(h / 0.014))
    return of(bar, *frame(d, w, h, 0.02)) + of(
        FELT,
        box((d * 0.5, w - 0.03, h - 0.03), 0.002).moved(-d * 0.2, 0, 0.015),
        *(box((0.004, w - 0.036, 0.009), 0.002).moved(d * 0.06, 0, float(z)) for z in zs),
    )


def rolling_board(size: Size, face: Material) -> Parts:
    """A writing board in a wheeled stand."""
    d, w, h = size
    board = [p.moved(z=0.72) for p in whiteboard((0.03, w - 0.08, h - 0.76), face)]
    posts = both_sides(box((0.025, 0.035, h - 0.06), 0.004).moved(0, w / 2 - 0.018, 0.06))
    feet = both_sides(box((d, 0.035, 0.03), 0.006, 2).moved(0, w / 2 - 0.018, 0.05))
    bar = box((0.025, w - 0.04, 0.025), 0.004).moved(0, 0, 0.2)
    wheels = [
        cylinder(0.026, 0.02, 0.005, 16).turned("x", 90).moved(sx * (d / 2 - 0.03), sy * (w / 2 - 0.018) + 0.01, 0.026)
        for sx in (1, -1)
        for sy in (1, -1)
    ]
    return board + of(m.STEEL, *posts, *feet, bar) + of(m.BLACK, *wheels)


def easel_board(size: Size, wood: Material) -> Parts:
    """A chalkboard that stands like an A."""
    d, w, h = size
    lean = float(np.rad2deg(np.arctan2(d / 2 - 0.02, h)))
    half = [
        p.turned("y", -lean).moved(d / 2 - 0.02)
        for p in of(wood, *frame(0.024, w, h * 0.99, 0.05))
        + of(CHALK, box((0.012, w - 0.08, h * 0.99 - 0.08), 0.002).moved(0, 0, 0.04))
    ]
    other = [p.turned("z", 180) for p in half]
    return half + other


CORK = m.Material("cork", "cork", "#b8946a", 0.95, 0.0, 0.3)
FELT = m.fabric("grey felt", "#5c6064", 0.3)
GREEN_FELT = m.fabric("green felt", "#5a6f62", 0.3)
NOTE = m.paint("yellow note", "#d8c98f", 0.9)
NOTE_BLUE = m.paint("blue note", "#9db1bd", 0.9)
PIN = m.paint("drawing pin", "#995b50", 0.4)


DESIGNS: tuple[Design, ...] = (
    design("whiteboard", "whiteboard", "whiteboard with a pen tray", (0.06, 1.50, 1.00), "industrial", whiteboard, id="picture-whiteboard", face=m.WHITE),
    design("whiteboard", "blackboard", "blackboard", (0.05, 1.20, 0.90), "rustic", whiteboard, id="picture-blackboard", face=CHALK),
    design("whiteboard", "large", "large frameless whiteboard", (0.05, 1.80, 1.10), "minimal", whiteboard, face=m.PORCELAIN),
    design("whiteboard", "rolling", "whiteboard on wheels", (0.55, 1.30, 1.80), "modern", rolling_board, face=m.PORCELAIN),
    design("whiteboard", "easel", "chalkboard easel", (0.50, 0.60, 1.05), "rustic", easel_board, 2, wood=m.PINE),
    design("bulletin board", "cork-oak", "cork board in an oak frame", (0.03, 0.90, 0.60), "rustic", bulletin, bar=m.OAK, face=CORK),
    design("bulletin board", "cork-white", "cork board in a white frame", (0.025, 0.60, 0.45), "minimal", bulletin, bar=m.WHITE, face=CORK, notes=3),
    design("bulletin board", "felt-green", "green felt noticeboard", (0.03, 1.20, 0.90), "classic", bulletin, bar=m.WALNUT, face=GREEN_FELT, notes=7),
    design("bulletin board", "felt-grey", "grey pinboard in a steel frame", (0.025, 1.00, 0.70), "industrial", bulletin, bar=m.STEEL, face=FELT),
    design("bulletin board", "letters", "letter board in an oak frame", (0.03, 0.42, 0.42), "modern", letter_board, bar=m.OAK),
)  # fmt: skip
