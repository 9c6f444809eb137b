"""The scene's mesh: ceiling cut, parts sent one by one, cut faces darkened."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import viser

from app.inspector.scene.cutting import CUT_M, cut_below
from app.inspector.scene.glb import Surface, pack
from app.inspector.scene.layer import Group
from app.inspector.scene.section import section_of
from app.inspector.scene.shading import shades_of
from app.inspector.scene.storey import storey_of
from app.session.snapshot import Snapshot
from c2nav_engine.geometry import Point
from c2nav_engine.world.scene import Scene

log = logging.getLogger(__name__)

_CHUNK_TRIANGLES = 150_000
"""Triangles of one message: the page shows parts as they arrive and stays usable meanwhile."""


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """A mesh and the height it is cut at; equal for one mesh object and height."""

    mesh: Scene
    height_m: float

    def __eq__(self, other: object) -> bool:
        """Meshes of millions of triangles are told apart by identity."""
        if not isinstance(other, Cut):
            return NotImplemented
        return self.mesh is other.mesh and self.height_m == other.height_m


class Mesh:
    """Draws below /scene; the nodes are replaced when the storey or the scene changes.

    Cutting and packing takes seconds for a large scan, so it runs on a thread of its own: panels
    and the other layers go on meanwhile.
    """

    def __init__(self, scene: viser.SceneApi, fetch: Callable[[], Scene | None]) -> None:
        """Remember where the loaded scene is found."""
        self._scene = scene
        self._fetch = fetch
        self._wanted: Cut | None = None
        self._drawn: Cut | None = None
        self._shown = True
        self._handles: list[viser.SceneNodeHandle] = []
        self._grid = Group(scene, "/floor")
        self._lock = threading.Lock()
        self._working = False

    def update(self, snapshot: Snapshot) -> None:
        """Send the mesh once it is there, and again on another storey."""
        mesh = self._fetch()
        self._show("scene" in snapshot.view.layers)
        missing = bool(snapshot.no_scene) and mesh is None
        start_m = snapshot.story.header.episode.start.position_m
        self._grid.draw(start_m if missing else None, lambda: self._floor(start_m))
        with self._lock:
            self._wanted = None if mesh is None else Cut(mesh, storey_of(snapshot) + CUT_M)
            if self._wanted == self._drawn or self._working:
                return
            self._working = True
        threading.Thread(target=self._keep_up, name="c2nav-mesh", daemon=True).start()

    def _show(self, shown: bool) -> None:
        self._shown = shown
        for handle in list(self._handles):
            if handle.visible != shown:
                handle.visible = shown

    def _keep_up(self) -> None:
        """Draw until what is drawn is what is wanted, which may change meanwhile."""
        while True:
            with self._lock:
                if self._wanted == self._drawn:
                    self._working = False
                    return
                self._drawn = wanted = self._wanted
            self._replace(wanted)

    def _replace(self, wanted: Cut | None) -> None:
        """Runs in a thread of its own, where nobody else would hear of what goes wrong."""
        try:
            stale, self._handles = self._handles, []
            kept: set[str] = set()
            for handle in () if wanted is None else draw_cut(self._scene, wanted):
                kept.add(handle.name)
                handle.visible = self._shown
                self._handles.append(handle)
            for handle in stale:
                if handle.name not in kept:
                    handle.remove()
        except Exception:
            log.exception("the scene could not be drawn")

    def _floor(self, start_m: Point) -> list[viser.SceneNodeHandle]:
        """A metre grid in place of a scene that is not to be had."""
        return [
            self._scene.add_grid(
                "/floor/grid",
                width=60.0,
                height=60.0,
                plane="xz",
                cell_size=1.0,
                section_size=5.0,
                position=start_m,
            )
        ]


def draw_cut(scene: viser.SceneApi, cut: Cut) -> Iterator[viser.SceneNodeHandle]:
    """Send what lies below a cut, and its cut face."""
    yield from draw_parts(scene, cut)
    yield from draw_section(scene, cut)


def draw_parts(scene: viser.SceneApi, cut: Cut) -> Iterator[viser.SceneNodeHandle]:
    """Send the mesh below the cut, a few parts at a time, as /scene/part0 and so on."""
    for index, surfaces in enumerate(chunks(cut.mesh, cut.height_m)):
        yield scene.add_glb(
            f"/scene/part{index}", pack(surfaces), cast_shadow=False, receive_shadow=False
        )


def draw_section(scene: viser.SceneApi, cut: Cut) -> Iterator[viser.SceneNodeHandle]:
    """Send the dark cut face at /scene/section, where the plane cuts anything."""
    mesh = cut.mesh
    groups = [mesh.vertices_m[mesh.triangles[part.first : part.stop]] for part in mesh.parts]
    section = section_of(groups, cut.height_m)
    if section is None:
        return
    yield scene.add_image(
        "/scene/section",
        section.rgba,
        section.size_m[0],
        section.size_m[1],
        format="png",
        # viser's picture stands in x and y and looks along −z: lay it on its back.
        wxyz=(0.7071068, 0.7071068, 0.0, 0.0),
        position=(section.centre_m[0], cut.height_m + 0.002, section.centre_m[1]),
        cast_shadow=False,
        receive_shadow=False,
    )


def chunks(mesh: Scene, height_m: float) -> Iterator[list[Surface]]:
    """Surfaces below the cut, a few parts at a time, one surface per material and chunk."""
    waiting: dict[int, list[tuple[int, int]]] = {}
    count = 0
    for part in mesh.parts:
        waiting.setdefault(part.material, []).append((part.first, part.stop))
        count += part.stop - part.first
        if count >= _CHUNK_TRIANGLES:
            yield from _chunk(mesh, waiting, height_m)
            waiting, count = {}, 0
    yield from _chunk(mesh, waiting, height_m)


def _chunk(
    mesh: Scene, runs: dict[int, list[tuple[int, int]]], height_m: float
) -> Iterator[list[Surface]]:
    surfaces = [
        surface
        for material, spans in runs.items()
        if (surface := _surface(mesh, material, spans, height_m)) is not None
    ]
    if surfaces:
        # Seen from above, what is high hides what is low: drawn first, it saves the browser pixels.
        yield sorted(surfaces, key=lambda one: -float(one.positions_m[:, 1].mean()))


def _surface(
    mesh: Scene, material: int, spans: list[tuple[int, int]], height_m: float
) -> Surface | None:
    index = np.concatenate([np.arange(first, stop) for first, stop in spans])
    triangles = mesh.triangles[index]
    corners_m = mesh.vertices_m[triangles]
    textured = mesh.uvs is not None and mesh.materials[material].texture is not None
    extra: list[np.ndarray] = []
    if textured and mesh.uvs is not None:
        extra.append(mesh.uvs[index])
    if mesh.colours is not None:
        extra.append(mesh.colours[triangles].astype(np.float32))
    blank = np.zeros((*corners_m.shape[:2], 0), np.float32)
    soup = cut_below(corners_m, np.concatenate(extra, axis=2) if extra else blank, height_m)
    if not len(soup.corners_m):
        return None
    topmost_first = np.argsort(-soup.corners_m[:, :, 1].max(axis=1), kind="stable")
    corners_m, values = soup.corners_m[topmost_first], soup.extra[topmost_first]
    flat = values.reshape(3 * len(values), values.shape[2])
    uvs = None
    if textured:
        uvs = flat[:, :2] * (1.0, -1.0) + (0.0, 1.0)  # ours from the bottom, glTF's from the top
        flat = flat[:, 2:]
    look = mesh.materials[material]
    return Surface(
        positions_m=corners_m.reshape(-1, 3).astype(np.float32),
        triangles=np.arange(3 * len(corners_m), dtype=np.uint32).reshape(-1, 3),
        material=look,
        uvs=None if uvs is None else uvs.astype(np.float32),
        colours=flat.round().clip(0, 255).astype(np.uint8) if mesh.colours is not None else None,
        # Photographs hold their own light.
        shades=None if look.unlit else np.repeat(shades_of(corners_m), 3),
    )
