from __future__ import annotations

from pathlib import Path

from diorama_app.projects.example import example_inputs, example_project


def test_the_example_is_copied_with_its_photo_and_retained_as_edited(tmp_path: Path) -> None:
    project = example_project(tmp_path)
    assert project is not None
    scene, inputs = project.load_scene(), project.load_inputs()
    assert inputs is not None
    assert len(scene.objects) >= 0.9 * len(example_inputs().inputs.boxes)
    assert scene.architecture.floor is not None
    assert scene.architecture.by_role("wall")
    for wall in scene.architecture.by_role("wall"):
        behind_m = wall.offset - scene.architecture.floor.polygon @ wall.normal
        assert behind_m.max() < 0.001, "the floor ends at its walls"
    assert inputs.photo.name == "rendering.jpg"  # it is called what it is where the editor shows it
    assert (inputs.photo.width, inputs.photo.height) == (
        scene.camera.intrinsics.width,
        scene.camera.intrinsics.height,
    )
    project.scene_path.write_text(project.scene_path.read_text().replace('"label": "sofa"', '"label": "settee"'))
    again = example_project(tmp_path)
    assert again is not None
    assert "settee" in [o.label for o in again.load_scene().objects]
