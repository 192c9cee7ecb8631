"""From nothing to an exported room by a stranger's path: every click, drag and key is counted, and there are few."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
from playwright.sync_api import expect

from diorama_app.projects.example import EXAMPLE
from diorama_app.serve import Running
from diorama_core.io.assets import has_own_recogniser
from diorama_core.review.questions import NO, TURNS, YES, Question, questions
from diorama_core.scene.types import Scene, SceneObject
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import ARTEFACTS, keep_picture
from tests.e2e.hand import Hand
from tests.few_shapes import example_scene, few_shapes

pytestmark = [pytest.mark.browser, pytest.mark.slow]

MAX_ACTIONS = 60
OBJECTS, MAX_ACTIONS_OF_A_PHOTO = 12, 25
"""A photo becomes an exported scene of so many objects in so few actions, with one swapped and moved."""
MAX_ANSWERS = 15
"""A photo that nobody marked anything in is reviewed by at most so many answers."""
BUILD_S = 300
SOFA, RUG = (735.0, 465.0, 1055.0, 650.0), (640.0, 800.0, 1240.0, 940.0)
"""Boxes of the example's photo (px)."""


@pytest.fixture
def hand(context, serve: Callable[..., Running], request: pytest.FixtureRequest) -> Iterator[Hand]:
    """A stranger before the start page."""
    editor = EditorPage.open(context, serve(library=few_shapes(example_scene())), newcomer=True)
    expect(editor.page.locator("#dio-start")).to_be_visible()
    hand = Hand(editor)
    yield hand
    keep_picture(editor, request.node.name)
    hand.save(ARTEFACTS / f"{request.node.name}.txt")
    editor.page.close()
    assert not editor.errors, editor.errors


def skip_tour(hand: Hand) -> None:
    """The tour comes a while after an empty room or an example was chosen on the start page, and lies over everything.

    The page of the room loads in between: a tour that was there before it comes again.
    """
    page = hand.editor.page
    page.wait_for_url("**project=**")
    tour = page.get_by_role("dialog", name="Tour")
    hand.click(tour.get_by_role("button", name="Skip"), "Skip, on the tour")
    expect(tour).to_have_count(0)


def tab(hand: Hand, name: str) -> None:
    hand.click(hand.editor.page.get_by_role("tab", name=name, exact=True), f"the tab {name}")


def export(hand: Hand, tmp_path: Path) -> None:
    """Download the scene and open it again."""
    scene = hand.editor.session.scene
    tab(hand, "Export")
    with hand.editor.page.expect_download(timeout=90_000) as download:
        hand.click(hand.editor.button("Export .glb"), "Export .glb")
    path = tmp_path / "room.glb"
    download.value.save_as(path)
    model = trimesh.load_scene(path)
    assert len(model.geometry) >= len(scene.objects)


def nearest_point(editor: EditorPage, item: SceneObject) -> tuple[float, float]:
    """Where the page shows what of an object is nearest to the camera: its middle may be the air below a table."""
    camera = editor.session.scene.camera
    assert camera is not None
    faces = editor.session.library.mesh(item.shape_id).triangles_center
    points = trimesh.transform_points(faces, item.pose.matrix)
    return editor.place_of(points[np.linalg.norm(points - camera.position, axis=1).argmin()])


def click_object(hand: Hand, item: SceneObject) -> None:
    """In the view; what something hides is clicked in the list."""
    editor = hand.editor
    editor.until_drawn(item.id)
    at = nearest_point(editor, item)
    hand.click(at, f"the {item.label} in the view")
    editor.page.wait_for_timeout(400)
    if editor.selection[-1:] != (item.id,):
        tab(hand, "Scene")
        hand.click(editor.page.locator(f'.dio .row[data-arg="{item.id}"] .name'), f"the {item.label} in the list")
    editor.until(lambda: editor.selection == (item.id,), f"{item.label} is selected")
    editor.settle()


def nearest(scene: Scene) -> SceneObject:
    """What has other shapes and stands on the floor nearest to the photo's camera, where nothing hides it."""
    assert scene.camera is not None
    eye, floor = scene.camera.position, scene.architecture.floor
    assert floor is not None
    several = [
        o
        for o in scene.objects
        if len({c.shape_id for c in o.candidates}) > 1
        and o.category != "rug"
        and (edge := scene.support_of(o.id)) is not None
        and edge.parent == floor.id
    ]
    return min(several, key=lambda o: float(np.linalg.norm(o.pose.position[:2] - eye[:2])))


@pytest.mark.skipif(not has_own_recogniser(), reason="no weights are shipped")
def test_from_a_photo_to_an_exported_room(hand: Hand, tmp_path: Path) -> None:
    editor, page = hand.editor, hand.editor.page
    hand.choose_file(page.locator("#dio-start label.main"), EXAMPLE / "photo.jpg")
    editor.until(lambda: editor.session.is_unbuilt, "a project of its own")
    editor.at_board()
    page.locator(".dio-canvas-proposal").first.wait_for(timeout=60_000)
    page.screenshot(path=str(ARTEFACTS / "journey-board.png"))
    session = editor.session
    expect(page.locator(".dio-canvas-lines")).to_be_visible(timeout=120_000)  # a build has begun by itself
    hand.click(page.get_by_role("button", name="Mark it myself").first, "Mark it myself")
    editor.until(lambda: session.jobs.status is None, "stopped", seconds=60)
    expect(page.locator(".dio-canvas-lines")).to_have_count(0)
    assert session.is_unbuilt
    page.get_by_role("button", name="Build at once").click()
    editor.button("Cancel").click()
    editor.until(lambda: session.jobs.status is None, "stopped again", seconds=60)
    expect(page.locator(".dio-canvas-proposal").first).to_be_visible()
    hand.click(page.get_by_role("button", name="Accept all").first, "Accept all")
    editor.until(lambda: bool(session.inputs.boxes), "accepted")
    number = len(session.inputs.boxes)
    hand.drag(editor.on_photo(*RUG[:2]), editor.on_photo(*RUG[2:]), "a box around the rug")
    editor.until(lambda: len(session.inputs.boxes) == number + 1, "the rug has a box")
    assert session.inputs.boxes[-1].label == "rug", "it is recognised"
    expect(page.locator(".dio-canvas-box.on input")).to_be_visible()
    hand.drag(editor.on_photo(*SOFA[:2]), editor.on_photo(*SOFA[2:]), "a box around the sofa")
    editor.until(lambda: len(session.inputs.boxes) == number + 2, "the sofa has a box")
    page.screenshot(path=str(ARTEFACTS / "journey-boxes.png"))
    hand.click(editor.build_button(), "Build scene")
    editor.until(
        lambda: session.jobs.status is None and len(session.scene.objects) > number + 1, "built", seconds=BUILD_S
    )
    editor.settle()
    page.screenshot(path=str(ARTEFACTS / "journey-built.png"))
    chosen = nearest(session.scene)
    click_object(hand, chosen)
    shape = session.viewport.mesh_name(chosen.id)
    hand.click(page.locator(".dio .tile:not(.on)[data-do=swap]").first, "another shape")
    editor.until(lambda: session.scene.object(chosen.id).shape_id != chosen.shape_id, "swapped")
    editor.until(lambda: session.viewport.mesh_name(chosen.id) != shape, "its other shape is sent")
    editor.until_drawn(chosen.id)
    start = nearest_point(editor, session.scene.object(chosen.id))
    hand.drag(start, (start[0] + 60, start[1] + 25), f"the {chosen.label}")
    editor.until(
        lambda: not np.allclose(session.scene.object(chosen.id).pose.position, chosen.pose.position, atol=0.02), "moved"
    )
    export(hand, tmp_path)
    assert len(session.scene.objects) >= OBJECTS
    assert hand.count <= MAX_ACTIONS_OF_A_PHOTO, "\n".join(hand.actions)


def test_from_an_empty_room_to_an_exported_one(hand: Hand, tmp_path: Path) -> None:
    editor, page = hand.editor, hand.editor.page
    hand.click(editor.button("Create empty room"), "Create empty room")
    editor.until(lambda: editor.session.project is not None and editor.session.project.name == "Empty room")
    skip_tour(hand)
    session = editor.session
    tab(hand, "Library")
    for number, words in enumerate(("sofa", "table", "lamp"), start=1):
        field = page.get_by_label("Search")
        hand.click(field, "the search field")
        if number > 1:
            hand.key("Control+a", "everything in it")
        hand.write(words)
        tile = page.locator(".dio div.tile", has_text=words).first
        hand.click(tile.get_by_role("button", name="Insert"), f"Insert, on a {words}")
        editor.until(lambda number=number: len(session.scene.objects) == number, f"{words} is there")
    tab(hand, "Scene")
    hand.click(page.locator(".dio .row:visible", has_text="Wall 3").first, "Wall 3 in the list")
    hand.click(page.locator(".dio .tile:visible", has_text="Paint"), "Paint")
    editor.until(lambda: session.scene.plane("wall_3").finish is not None, "painted")
    export(hand, tmp_path)
    assert hand.count < MAX_ACTIONS, "\n".join(hand.actions)


def test_from_a_description_to_an_exported_room(hand: Hand, tmp_path: Path) -> None:
    editor, page = hand.editor, hand.editor.page
    earlier = editor.session
    hand.click(page.get_by_label("Description of the room"), "the description")
    hand.write("a bed, a desk, two lamps")
    hand.click(editor.button("Create room"), "Create room")
    editor.until(
        lambda: (
            editor.session is not earlier
            and editor.session.jobs.status is None
            and len(editor.session.scene.objects) >= 4
        ),
        "furnished",
        seconds=60,
    )
    editor.settle()
    page.screenshot(path=str(ARTEFACTS / "journey-described.png"))
    session = editor.session
    tab(hand, "Scene")
    hand.click(page.locator(".dio .row:visible", has_text="Wall").first, "a wall in the list")
    hand.click(page.locator(".dio .tile:visible", has_text="Paint"), "Paint")
    editor.until(lambda: any(p.finish is not None for p in session.scene.architecture.planes), "painted")
    export(hand, tmp_path)
    assert hand.count < MAX_ACTIONS, "\n".join(hand.actions)


@pytest.mark.skipif(not has_own_recogniser(), reason="no weights are shipped")
def test_from_a_photo_to_a_reviewed_room_without_marking_anything(hand: Hand) -> None:
    """Somebody who knows the room answers what the review asks, by keys; what it took is written down."""
    editor, page = hand.editor, hand.editor.page
    hand.choose_file(page.locator("#dio-start label.main"), EXAMPLE / "photo.jpg")
    editor.until(lambda: editor.session.is_unbuilt, "a project of its own")
    session = editor.session
    editor.until(lambda: bool(session.scene.objects), "built", seconds=BUILD_S)
    card = page.locator(".job.card", has_text="sure")
    expect(card).to_be_visible(timeout=60_000)
    before, truth = _right(session.scene), example_scene()
    hand.click(card.get_by_role("button", name="Review"), "Review")
    waits, begun = [], time.monotonic()
    while len(waits) < MAX_ANSWERS and (asked := questions(session.scene)):
        question = asked[0]
        expect(page.locator(".review")).to_contain_text(question.sentence)
        known = [c.value for c in question.choices]
        answer = _true_answer(session.scene, truth, question)
        pressed, scene = time.monotonic(), session.scene
        hand.key(str(known.index(answer) + 1 if answer in known else 1), f"{question.sentence} {answer}")
        editor.until(lambda scene=scene: session.scene is not scene, "answered")
        after = questions(session.scene)
        if after:
            expect(page.locator(".review")).to_contain_text(f"{len(after)} question")
        waits.append(time.monotonic() - pressed)
    spent = time.monotonic() - begun
    said = f"right {before:.2f} > {_right(session.scene):.2f}"
    hand.actions.append(f"{len(waits)} answers in {spent:.0f} s, slowest {max(waits):.1f} s; {said}")
    page.screenshot(path=str(ARTEFACTS / "journey-reviewed.png"))
    assert _right(session.scene) > before
    assert not questions(session.scene) or len(waits) == MAX_ANSWERS


def _right(scene: Scene) -> float:
    known = [o.belief.right for o in scene.objects if o.belief is not None]
    return sum(known) / len(known)


def _true_answer(scene: Scene, truth: Scene, question: Question) -> str:
    """What somebody who knows the room says of the object that is where the question's one is in the photo."""
    item = scene.object(question.object_id)
    assert item.box_px is not None
    assert truth.camera is not None
    assert scene.camera is not None
    x1, y1, x2, y2 = item.box_px
    seen = [(truth.camera.project(o.pose.position), o) for o in truth.objects]
    inside = [
        (abs(p[0] - (x1 + x2) / 2) + abs(p[1] - (y1 + y2) / 2), o) for p, o in seen if x1 < p[0] < x2 and y1 < p[1] < y2
    ]
    if not inside:
        return NO if question.subject == "presence" else question.choices[0].value
    true = min(inside, key=lambda pair: pair[0])[1]
    if question.subject == "presence":
        return YES
    if question.subject == "kind":
        return true.category
    if question.subject == "scale":
        return min((c.value for c in question.choices), key=lambda v: abs(float(v) - float(true.size_m[2])))
    if question.subject == "supporter":
        edge = truth.support_of(true.id)
        role = truth.plane(edge.parent).role if edge is not None and truth.has_plane(edge.parent) else None
        planes = (c.value for c in question.choices if scene.has_plane(c.value) and scene.plane(c.value).role == role)
        return next(planes, question.choices[0].value)
    views = [np.arctan2(*s.camera.T_world_camera[1::-1, 2]) for s in (truth, scene) if s.camera is not None]
    turn = (true.pose.yaw_rad - views[0]) - (item.pose.yaw_rad - views[1])
    return TURNS[round(turn / (np.pi / 2)) % len(TURNS)]
