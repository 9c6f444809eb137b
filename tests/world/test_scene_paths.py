"""Scene ids resolve under the usual names, below the scenes folder and nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

from c2nav_engine.errors import SceneError
from c2nav_engine.world.load import scene_path


def placed(folder: Path, name: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"x")
    return path


@pytest.mark.parametrize(
    "where",
    [
        "mp3d/SCAN/SCAN.glb",
        "SCAN/SCAN.glb",
        "data/scene_datasets/mp3d/SCAN/SCAN.glb",
        "mp3d/SCAN/SCAN.ply",
    ],
)
@pytest.mark.parametrize(
    "scene_id",
    [
        "mp3d/SCAN/SCAN.glb",
        "SCAN/SCAN.glb",
        "SCAN/SCAN",
        "SCAN",
        "data/scene_datasets/mp3d/SCAN/SCAN.glb",
        "data/scene_datasets/SCAN/SCAN.glb",
    ],
)
def test_an_id_is_found_under_the_usual_names(tmp_path, where, scene_id):
    path = placed(tmp_path, where)
    assert scene_path(tmp_path, scene_id) == path


@pytest.mark.parametrize("scene_id", ["house", "house.glb", "mp3d/house.glb"])
def test_a_flat_folder_will_do(tmp_path, scene_id):
    assert scene_path(placed(tmp_path, "house.glb").parent, scene_id) == tmp_path / "house.glb"


def test_the_exact_name_wins(tmp_path):
    placed(tmp_path, "mp3d/SCAN/SCAN.glb")
    exact = placed(tmp_path, "SCAN/SCAN.glb")
    assert scene_path(tmp_path, "SCAN/SCAN.glb") == exact


def test_glb_comes_before_ply(tmp_path):
    placed(tmp_path, "mp3d/SCAN/SCAN.ply")
    glb = placed(tmp_path, "mp3d/SCAN/SCAN.glb")
    assert scene_path(tmp_path, "SCAN") == glb


def test_the_error_lists_what_was_tried(tmp_path):
    with pytest.raises(SceneError) as caught:
        scene_path(tmp_path, "mp3d/SCAN/SCAN.glb")
    message = str(caught.value)
    assert str(tmp_path) in message
    assert "mp3d/SCAN/SCAN.glb" in message
    assert "SCAN/SCAN.ply" in message
    assert "--scenes" in message


@pytest.mark.parametrize(
    "scene_id",
    ["", " ", "../secret.glb", "mp3d/../../secret.glb", "/etc/secret.glb", "..\\secret.glb"],
)
def test_an_id_cannot_leave_the_folder(tmp_path, scene_id):
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    placed(tmp_path, "secret.glb")
    with pytest.raises(SceneError, match="expected a scene id below"):
        scene_path(scenes, scene_id)
