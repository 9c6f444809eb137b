"""Scenes come back from disk as they went; lighter meshes keep their shape."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
from PIL import Image

from c2nav_engine.runner.scene_cache import cached_scene, display_scene
from c2nav_engine.world.lighten import lightened
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.scene import Material, Piece, Scene, scene_of
from c2nav_engine.world.scene_store import FACTS, open_scene, save_scene

RNG = np.random.default_rng(0)


def grid(material: Material, *, side: int = 40, size_m: float = 10.0, coloured: bool = False):
    """A floor of side × side squares, two triangles each."""
    steps = np.linspace(0.0, size_m, side + 1)
    x, z = (axis.reshape(-1) for axis in np.meshgrid(steps, steps, indexing="ij"))
    vertices = np.stack([x, np.zeros_like(x), z], axis=1).astype(np.float32)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).reshape(-1)
    near, far = first + 1, first + side + 1
    triangles = np.concatenate([np.stack([first, near, far], 1), np.stack([far, near, far + 1], 1)])
    triangles = triangles.astype(np.int32)
    uvs = None if material.texture is None else vertices[triangles][:, :, (0, 2)] / size_m
    colours = np.full((len(vertices), 4), 200, np.uint8) if coloured else None
    return Piece("floor", material, vertices, triangles, uvs, colours)


@pytest.fixture
def scene() -> Scene:
    texture = RNG.integers(0, 256, (32, 16, 4), dtype=np.uint8)
    textured = Material("photo", (0.5, 1.0, 1.0, 1.0), texture, 0.25, unlit=True)
    pieces = [grid(textured), grid(Material("paint", (0.1, 0.2, 0.3, 1.0)), coloured=True)]
    return scene_of("two floors", pieces, licence="free to use")


def equal(left: np.ndarray | None, right: np.ndarray | None) -> bool:
    return np.array_equal(left, right) if left is not None and right is not None else left is right


def same(left: Scene, right: Scene) -> bool:
    arrays = ("vertices_m", "triangles", "uvs", "colours")
    return (
        all(equal(getattr(left, name), getattr(right, name)) for name in arrays)
        and left.parts == right.parts
        and (left.licence, left.sha256) == (right.licence, right.sha256)
        and all(
            (a.name, a.colour, a.cutout_alpha, a.unlit)
            == (b.name, b.colour, b.cutout_alpha, b.unlit)
            and equal(a.texture, b.texture)
            for a, b in zip(left.materials, right.materials, strict=True)
        )
    )


def test_a_saved_scene_comes_back_whole(tmp_path, scene):
    save_scene(tmp_path, scene)
    opened = open_scene(tmp_path, name=scene.name)
    assert same(opened, scene)
    # The digest was kept, not made again: it must be that of the content all the same.
    arrays = (opened.vertices_m, opened.triangles, opened.parts, opened.materials)
    assert Scene("", *arrays, opened.uvs, opened.colours).sha256 == scene.sha256


def test_a_picture_is_kept_as_the_file_had_it(tmp_path):
    buffer = io.BytesIO()
    photo = RNG.integers(0, 256, (64, 64, 3), dtype=np.uint8)
    Image.fromarray(photo).save(buffer, "JPEG")
    texture = np.asarray(Image.open(io.BytesIO(buffer.getvalue())).convert("RGBA"))
    scene = scene_of("s", [grid(Material("m", texture=texture))])
    other = b"\x89PNG is not this"
    save_scene(tmp_path, scene, pictures=[buffer.getvalue()])
    assert (tmp_path / "texture0").read_bytes() == buffer.getvalue() != other
    assert same(open_scene(tmp_path, name="s"), scene)


@pytest.mark.parametrize("harm", ["version", "short", "gone", "garbled"])
def test_a_damaged_folder_is_refused(tmp_path, scene, harm):
    save_scene(tmp_path, scene)
    facts = tmp_path / FACTS
    if harm == "version":
        facts.write_text(json.dumps({**json.loads(facts.read_text()), "version": 0}))
    elif harm == "short":
        np.save(tmp_path / "triangles.npy", scene.triangles[:-1])
    elif harm == "gone":
        (tmp_path / "vertices_m.npy").unlink()
    else:
        facts.write_text("{")
    with pytest.raises(ValueError):
        open_scene(tmp_path, name="s")


def written(path, colour=(200, 200, 200, 255), shift_m: float = 0.0):
    """A small `.glb` of one floor with a photograph."""
    trimesh = pytest.importorskip("trimesh")
    piece = grid(Material("m"), side=8)
    visual = trimesh.visual.TextureVisuals(
        uv=piece.vertices_m[:, (0, 2)] / 10.0,
        material=trimesh.visual.material.PBRMaterial(
            name="m", baseColorTexture=Image.new("RGB", (8, 8), colour[:3])
        ),
    )
    mesh = trimesh.Trimesh(
        piece.vertices_m + shift_m, piece.triangles, visual=visual, process=False
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    trimesh.Scene({"floor": mesh}).export(path)
    return path


def kept(cache) -> list[str]:
    return sorted(path.name for path in cache.glob("scenes/*"))


def test_the_cache_gives_what_the_loader_gives(tmp_path):
    path, cache = written(tmp_path / "a.glb"), tmp_path / "cache"
    first = cached_scene(path, cache, smallest_bytes=0)
    second = cached_scene(path, cache, smallest_bytes=0)
    assert same(first, load_scene(path))
    assert same(second, first)
    assert second.name == "a"
    assert len(kept(cache)) == 1


def test_the_cache_goes_by_content_and_not_by_name(tmp_path):
    cache = tmp_path / "cache"
    cached_scene(written(tmp_path / "a.glb"), cache, smallest_bytes=0)
    renamed = cached_scene(written(tmp_path / "b.glb"), cache, smallest_bytes=0)
    assert renamed.name == "b"
    assert len(kept(cache)) == 1
    cached_scene(written(tmp_path / "a.glb", shift_m=1.0), cache, smallest_bytes=0)
    assert len(kept(cache)) == 2


def test_a_scan_keeps_its_own_light_wherever_the_same_bytes_lay_before(tmp_path):
    cache = tmp_path / "cache"
    plain = cached_scene(written(tmp_path / "a.glb"), cache, smallest_bytes=0)
    scan = cached_scene(written(tmp_path / "mp3d" / "a.glb"), cache, smallest_bytes=0)
    assert not plain.materials[0].unlit
    assert scan.materials[0].unlit


def test_a_damaged_cache_is_made_again(tmp_path):
    path, cache = written(tmp_path / "a.glb"), tmp_path / "cache"
    first = cached_scene(path, cache, smallest_bytes=0)
    (cache / "scenes" / kept(cache)[0] / "triangles.npy").write_bytes(b"spoilt")
    assert same(cached_scene(path, cache, smallest_bytes=0), first)
    assert same(cached_scene(path, cache, smallest_bytes=0), first)


def test_small_files_and_files_that_lean_on_others_are_not_kept(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    cache = tmp_path / "cache"
    cached_scene(written(tmp_path / "a.glb"), cache)
    trimesh.creation.box().export(tmp_path / "box.obj")
    cached_scene(tmp_path / "box.obj", cache, smallest_bytes=0)
    assert kept(cache) == []


def test_a_cache_that_cannot_be_written_is_done_without(tmp_path, caplog):
    (tmp_path / "cache").write_bytes(b"a file in the way")
    scene = cached_scene(written(tmp_path / "a.glb"), tmp_path / "cache", smallest_bytes=0)
    assert len(scene.triangles) == 128
    assert "not cached" in caplog.text


@pytest.mark.parametrize("most", [3000, 800, 100])
def test_a_lighter_mesh_keeps_to_its_number_and_its_shape(scene, most):
    light = lightened(scene, triangles=most)
    assert 0 < len(light.triangles) <= most
    assert {part.material for part in light.parts} == {0, 1}
    gap_m = np.abs(light.bounds_m - scene.bounds_m).max()
    assert gap_m < 10.0 / np.sqrt(most / 8)
    corners = light.vertices_m[light.triangles]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Two floors of 100 m² lie on one another; clustering nibbles at their rim only.
    assert 2 * (10.0 - 2 * gap_m) ** 2 - 1.0 < np.linalg.norm(cross, axis=1).sum() / 2 < 201.0


def test_a_lighter_mesh_is_split_by_region(scene):
    light = lightened(scene, triangles=2000)
    centres = light.vertices_m[light.triangles].mean(axis=1)
    for part in light.parts:
        spread = np.ptp(centres[part.first : part.stop], axis=0)
        assert spread.max() <= 4.0


def test_pictures_stay_where_they_were(scene):
    light = lightened(scene, triangles=1000)
    textured = np.concatenate([np.arange(p.first, p.stop) for p in light.parts if p.material == 0])
    places = light.vertices_m[light.triangles[textured]][:, :, (0, 2)] / 10.0
    assert light.uvs is not None
    assert np.abs(light.uvs[textured] - places).max() < 0.1


def test_what_a_browser_can_show_is_shown_as_it_is(tmp_path, scene):
    assert display_scene(scene, tmp_path) is scene
    light = display_scene(scene, tmp_path, triangles=1000)
    assert same(display_scene(scene, tmp_path, triangles=1000), light)
    assert len(list(tmp_path.glob("display/*"))) == 1
