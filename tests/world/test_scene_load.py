"""Scene files: geometry, looks and names survive loading, and damage is refused with a reason."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
import trimesh.visual
from PIL import Image

from c2nav_engine.errors import SceneError
from c2nav_engine.world.load import load_scene

WHITE = (1.0, 1.0, 1.0, 1.0)


def quad(**visual) -> trimesh.Trimesh:
    """A unit square in the x–y plane with upright texture coordinates."""
    return trimesh.Trimesh(
        vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
        faces=[[0, 1, 2], [0, 2, 3]],
        process=False,
        **visual,
    )


def textured(image: Image.Image, **material) -> trimesh.Trimesh:
    look = trimesh.visual.material.PBRMaterial(baseColorTexture=image, name="look", **material)
    uvs = np.asarray([[0, 0], [1, 0], [1, 1], [0, 1]], np.float64)
    return quad(visual=trimesh.visual.TextureVisuals(uv=uvs, material=look))


def written(tmp_path: Path, geometry, suffix: str = ".glb") -> Path:
    path = tmp_path / f"made{suffix}"
    scene = geometry if isinstance(geometry, trimesh.Scene) else trimesh.Scene(geometry)
    scene.export(str(path))
    return path


def picture(mode: str) -> Image.Image:
    """Two rows: the upper brighter than the lower, in any picture mode."""
    grey = Image.fromarray(np.asarray([[200, 200], [40, 40]], np.uint8))
    return grey.convert(mode)


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "P", "L", "LA"])
def test_any_picture_mode_becomes_rgba(tmp_path, mode):
    scene = load_scene(written(tmp_path, textured(picture(mode))), up="y")
    texture = scene.materials[0].texture
    assert texture is not None
    assert texture.shape == (2, 2, 4)
    assert abs(int(texture[0, 0, 0]) - 200) <= 1
    assert abs(int(texture[1, 0, 0]) - 40) <= 1
    assert (texture[..., 3] == 255).all()


def test_texture_coordinates_start_at_the_bottom_left(tmp_path):
    scene = load_scene(written(tmp_path, textured(picture("RGB"))), up="y")
    corners = scene.vertices_m[scene.triangles]
    assert scene.uvs is not None
    assert np.allclose(scene.uvs, corners[..., :2])


def test_a_colour_factor_stays_linear(tmp_path):
    look = trimesh.visual.material.PBRMaterial(baseColorFactor=[255, 0, 128, 255], name="paint")
    mesh = quad(visual=trimesh.visual.TextureVisuals(material=look))
    material = load_scene(written(tmp_path, mesh), up="y").materials[0]
    assert material.name == "paint"
    assert material.texture is None
    assert material.colour == pytest.approx((1.0, 0.0, 128 / 255, 1.0))


def test_vertex_colours_become_srgb(tmp_path):
    colours = np.asarray([[255, 0, 55, 255]] * 4, np.uint8)
    scene = load_scene(written(tmp_path, quad(vertex_colors=colours)), up="y")
    assert scene.colours is not None
    # glTF stores them linear: 55/255 of the light is about half way up the sRGB scale.
    assert scene.colours[0].tolist() == [255, 0, 128, 255]


@pytest.mark.parametrize(
    ("mode", "cutoff", "expected"),
    [("OPAQUE", None, 0.0), ("MASK", 0.3, 0.3), ("MASK", None, 0.5), ("BLEND", None, 0.5)],
)
def test_only_declared_transparency_cuts(tmp_path, mode, cutoff, expected):
    mesh = textured(picture("RGBA"), alphaMode=mode, alphaCutoff=cutoff)
    assert load_scene(written(tmp_path, mesh), up="y").materials[0].cutout_alpha == expected


def test_node_transforms_are_baked_and_names_kept(tmp_path):
    scene = trimesh.Scene()
    mesh = quad()
    scene.add_geometry(mesh, node_name="near", geom_name="square")
    moved = trimesh.transformations.translation_matrix([5.0, 0.0, 0.0])
    scene.graph.update("far", matrix=moved, geometry="square")
    loaded = load_scene(written(tmp_path, scene), up="y")
    assert sorted(part.name for part in loaded.parts) == ["far", "near"]
    assert np.allclose(loaded.bounds_m, [[0, 0, 0], [6, 1, 0]])
    part = next(part for part in loaded.parts if part.name == "far")
    far = loaded.vertices_m[loaded.triangles[part.first : part.stop].reshape(-1)]
    assert far[:, 0].min() == pytest.approx(5.0)


def test_pieces_share_a_texture_that_the_file_shares(tmp_path):
    mesh = textured(picture("RGB"))
    scene = trimesh.Scene()
    scene.add_geometry(mesh, node_name="a", geom_name="a")
    scene.add_geometry(mesh.copy(), node_name="b", geom_name="b")
    loaded = load_scene(written(tmp_path, scene), up="y")
    assert len(loaded.parts) == 2
    assert len({id(material.texture) for material in loaded.materials}) == 1


def test_points_and_lines_are_left_out(tmp_path):
    scene = trimesh.Scene()
    scene.add_geometry(quad(), node_name="mesh", geom_name="mesh")
    scene.add_geometry(trimesh.PointCloud(np.eye(3)), node_name="points", geom_name="points")
    assert [part.name for part in load_scene(written(tmp_path, scene), up="y").parts] == ["mesh"]


def test_obj_keeps_objects_materials_and_textures(tmp_path):
    Image.fromarray(np.full((2, 2, 3), 90, np.uint8)).save(tmp_path / "wood.png")
    (tmp_path / "made.mtl").write_text(
        "newmtl wood\nKd 0.8 0.8 0.8\nmap_Kd wood.png\nnewmtl red\nKd 1 0 0\n", encoding="utf-8"
    )
    (tmp_path / "made.obj").write_text(
        "mtllib made.mtl\n"
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
        "o table\nusemtl wood\nf 1/1 2/2 3/3\n"
        "o chair\nusemtl red\nf 1 3 4\n",
        encoding="utf-8",
    )
    scene = load_scene(tmp_path / "made.obj", up="y")
    by_object = {part.name.split("_")[0]: scene.materials[part.material] for part in scene.parts}
    assert set(by_object) == {"table", "chair"}
    assert by_object["table"].texture is not None
    assert by_object["table"].texture[0, 0, :3].tolist() == [90, 90, 90]
    assert by_object["table"].colour == WHITE
    assert by_object["chair"].texture is None
    assert by_object["chair"].colour == (1.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_ply_keeps_vertex_colours_as_seen(tmp_path, encoding):
    mesh = quad(vertex_colors=np.asarray([[10, 20, 200, 255]] * 4, np.uint8))
    path = tmp_path / "made.ply"
    mesh.export(str(path), encoding=encoding)
    scene = load_scene(path, up="y")
    assert scene.colours is not None
    assert scene.colours[2].tolist() == [10, 20, 200, 255]


def test_ply_face_colours_stay_on_their_faces(tmp_path):
    path = tmp_path / "made.ply"
    quad(face_colors=np.asarray([[255, 0, 0, 255], [0, 0, 255, 255]], np.uint8)).export(str(path))
    scene = load_scene(path, up="y")
    assert scene.colours is not None
    assert scene.colours[scene.triangles[0]][:, 0].tolist() == [255] * 3
    assert scene.colours[scene.triangles[1]][:, 2].tolist() == [255] * 3


# ---------------------------------------------------------------- axes


def room(up: str) -> trimesh.Trimesh:
    extents = {"y": (6.0, 2.5, 8.0), "z": (6.0, 8.0, 2.5)}[up]
    return trimesh.creation.box(extents=extents)


@pytest.mark.parametrize("up", ["y", "z"])
def test_auto_finds_the_flat_axis(tmp_path, up):
    low_m, high_m = load_scene(written(tmp_path, room(up))).bounds_m
    assert (high_m - low_m).tolist() == pytest.approx([6.0, 2.5, 8.0])


def test_z_up_is_turned_and_never_mirrored(tmp_path):
    mesh = trimesh.Trimesh([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2]], process=False)
    scene = load_scene(written(tmp_path, mesh), up="z")
    turned = scene.vertices_m[scene.triangles[0]]
    assert turned.tolist() == [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    assert np.linalg.det(turned) == pytest.approx(1.0)


def test_the_habitat_test_room_is_z_up(shared):
    path = shared / "scenes" / "habitat_simple_room.glb"
    assert load_scene(path).sha256 == load_scene(path, up="z").sha256
    low_m, high_m = load_scene(path).bounds_m
    assert 2.0 < high_m[1] - low_m[1] < 2.5


def test_the_furnished_house_stands_upright(shared):
    scene = load_scene(shared / "scenes" / "house" / "aws_small_house_yup.glb")
    assert len(scene.triangles) == 145_844
    assert np.allclose(scene.bounds_m, [[-9.5, 0.0, -5.7], [9.5, 3.0, 5.7]], atol=2e-3)
    assert any(part.name.startswith("Refrigerator_01_001/") for part in scene.parts)
    assert sum(material.texture is not None for material in scene.materials) >= 50


# ---------------------------------------------------------------- what the header says


def glb_with(tmp_path: Path, change) -> Path:
    """A good file whose JSON header was changed."""
    data = written(tmp_path, textured(picture("RGB"))).read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    header = json.loads(data[20 : 20 + length])
    change(header)
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    chunk = struct.pack("<I", len(text)) + b"JSON" + text
    rest = data[20 + length :]
    path = tmp_path / "changed.glb"
    path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunk) + len(rest)) + chunk + rest)
    return path


@pytest.mark.parametrize(
    ("asset", "expected"),
    [
        ({"copyright": "CC0"}, "CC0"),
        ({"extras": {"license": "CC-BY 4.0"}, "copyright": "Somebody"}, "CC-BY 4.0"),
        ({}, ""),
    ],
)
def test_the_licence_travels_along(tmp_path, asset, expected):
    path = glb_with(tmp_path, lambda header: header["asset"].update(asset))
    assert load_scene(path, up="y").licence == expected


def test_unlit_materials_and_photographed_scenes_are_not_shaded(tmp_path):
    def unlit(header):
        header["materials"][0]["extensions"] = {"KHR_materials_unlit": {}}

    path = glb_with(tmp_path, unlit)
    assert load_scene(path, up="y").materials[0].unlit
    plain = written(tmp_path, textured(picture("RGB")))
    assert not load_scene(plain, up="y").materials[0].unlit
    scan = tmp_path / "mp3d" / "SCAN" / "SCAN.glb"
    scan.parent.mkdir(parents=True)
    plain.rename(scan)
    assert load_scene(scan, up="y").materials[0].unlit


# ---------------------------------------------------------------- what cannot be used


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(SceneError, match=r"nowhere\.glb: expected a file"):
        load_scene(tmp_path / "nowhere.glb")


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".ply", ".obj"])
@pytest.mark.parametrize("content", [b"", b"\x00garbage\xff" * 40], ids=["empty", "garbage"])
def test_empty_and_unreadable_files_are_refused(tmp_path, suffix, content):
    path = tmp_path / f"bad{suffix}"
    path.write_bytes(content)
    with pytest.raises(SceneError, match=r"bad\.\w+: expected"):
        load_scene(path)


def test_an_unknown_format_is_refused(tmp_path):
    path = tmp_path / "scene.step"
    path.write_bytes(b"ISO-10303-21;")
    with pytest.raises(SceneError, match=r"expected one of \.glb"):
        load_scene(path)


@pytest.mark.parametrize("suffix", [".glb", ".ply"])
@pytest.mark.parametrize("kept", [0.05, 0.3, 0.6, 0.9, 0.99])
def test_a_file_cut_short_is_refused(tmp_path, suffix, kept):
    mesh = trimesh.creation.icosphere(subdivisions=2)
    whole = written(tmp_path, mesh, ".glb") if suffix == ".glb" else tmp_path / "made.ply"
    if suffix == ".ply":
        mesh.export(str(whole))
    data = whole.read_bytes()
    cut = tmp_path / f"cut{suffix}"
    cut.write_bytes(data[: int(len(data) * kept)])
    with pytest.raises(SceneError, match=r"cut\.\w+: expected"):
        load_scene(cut)


def test_an_old_gltf_is_refused(tmp_path):
    path = tmp_path / "old.glb"
    path.write_bytes(b"glTF" + struct.pack("<II", 1, 24) + struct.pack("<I", 4) + b"JSON" + b"{}  ")
    with pytest.raises(SceneError, match=r"expected glTF 2, came version 1"):
        load_scene(path)


def test_a_file_without_triangles_is_refused(tmp_path):
    path = written(tmp_path, trimesh.PointCloud(np.eye(3)))
    with pytest.raises(SceneError, match=r"expected triangles, came none"):
        load_scene(path)


def test_loading_stays_clear_of_open3d(tmp_path):
    path = written(tmp_path, quad())
    code = (
        "import sys; from pathlib import Path; from c2nav_engine.world.load import load_scene; "
        f"load_scene(Path({str(path)!r})); sys.exit('open3d' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
