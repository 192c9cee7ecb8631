from __future__ import annotations

import numpy as np
import pytest

from diorama_app.viewport.client_view import PLANE_LIFT_M, ClientView
from tests.app.people import LocalClient, node
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()


@pytest.fixture
def view(server):
    made = ClientView(LocalClient(server, 0))
    yield made
    made.canvas.close()
    server.scene.reset()


def test_edges_of_planes_run_around_them_just_off_their_surface(server, view) -> None:
    planes = SCENE.architecture.planes[:2]
    view.show_planes([(p.id, p) for p in planes])
    for number, plane in enumerate(planes):
        edges = node(server, f"/planes/{number}/edges").points
        np.testing.assert_allclose((edges - plane.polygon[0]) @ plane.normal, PLANE_LIFT_M, atol=1e-6)
        np.testing.assert_allclose(edges[:, 1], np.roll(edges[:, 0], -1, axis=0))
    view.show_planes([])
    assert node(server, "/planes/0/edges") is None


def test_a_tape_needs_two_ends_and_goes_away(server, view) -> None:
    view.show_measure([(0.0, 0.0, 1.0)], "")
    assert node(server, "/tape/0") is not None
    assert node(server, "/tape/line") is None
    view.show_measure([(0.0, 0.0, 1.0), (2.0, 0.0, 1.0)], "2.00 m")
    assert node(server, "/tape/length").text == "2.00 m"
    np.testing.assert_allclose(node(server, "/tape/length").position, (1.0, 0.0, 1.0))
    view.show_measure((), "")
    assert node(server, "/tape/0") is None
    assert node(server, "/tape/length") is None


def test_notices_reach_the_page(view) -> None:
    view.notice("the photo is outlined", "good")
    assert view._viser_client.told == ["the photo is outlined"]


def test_distances_are_told_once_and_taken_away(view) -> None:
    told = view._distances
    ends = np.array([0.0, 1.0, 0.5]), np.array([0.30000001, 1.0, 0.5])
    view.show_distances([(*ends, "0' 11 3/4\"")])
    first = told.content
    assert "__dioDistances.told([[[0.0,1.0,0.5],[0.3,1.0,0.5],&quot;0&#x27; 11 3/4\\&quot;&quot;]])" in first
    view.show_distances([(ends[0], ends[1] + 1e-6, "0' 11 3/4\"")])
    assert told.content == first
    view.show_distances([])
    assert "told([])" in told.content
