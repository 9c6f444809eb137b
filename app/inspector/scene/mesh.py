"""The scene's mesh: ceiling cut, cut faces darkened, sent once it is whole."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np
import viser

from app.inspector.scene.cutting import CUT_M
from app.inspector.scene.glb import Surface, pack
from app.inspector.scene.layer import Group
from app.inspector.scene.section import Section, section_of
from app.inspector.scene.storey import storey_of
from app.inspector.scene.surfaces import surface_below
from app.session.snapshot import Snapshot
from c2nav_engine.geometry import Point
from c2nav_engine.world.scene import Scene

log = logging.getLogger(__name__)

_CHUNK_TRIANGLES = 150_000
"""Triangles of one message: the page reads one after the other and stays usable meanwhile."""


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

    def __init__(
        self,
        scene: viser.SceneApi,
        fetch: Callable[[], Scene | None],
        together: Callable[[], AbstractContextManager[None]],
        sent: Callable[[], None],
    ) -> None:
        """Draw nothing yet.

        Args:
            scene: Where to draw.
            fetch: The loaded scene, once it is there.
            together: Within it, messages are held back and sent as one.
            sent: Called whenever a scene is on its way.
        """
        self._scene = scene
        self._fetch = fetch
        self._together = together
        self._sent = sent
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
            cutaway = None if wanted is None else cutaway_of(wanted)
            # All at once: a browser without a GPU takes half a second for each frame of a large
            # scan, and reads what came for the next one only after it.
            with self._together():
                stale = {handle.name: handle for handle in self._handles}
                self._handles = [] if cutaway is None else list(send(self._scene, cutaway))
                for handle in self._handles:
                    handle.visible = self._shown
                    stale.pop(handle.name, None)
                for handle in stale.values():
                    handle.remove()
        except Exception:
            log.exception("the scene could not be drawn")
        self._sent()

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


@dataclass(frozen=True, slots=True)
class Cutaway:
    """What is sent of a mesh.

    Attributes:
        parts: Binary glTF, a few parts of the mesh each.
        section: The dark cut face; None where the plane cuts nothing.
        height_m: Of the cut.
    """

    parts: tuple[bytes, ...]
    section: Section | None
    height_m: float


def cutaway_of(cut: Cut, *, whole: Scene | None = None) -> Cutaway:
    """Cut and pack a mesh, which takes seconds for a large scan.

    Args:
        cut: The mesh as it is sent, and where it is cut.
        whole: The mesh that the cut face is taken from, where the sent one was made light.
    """
    mesh = whole or cut.mesh
    groups = [mesh.vertices_m[mesh.triangles[part.first : part.stop]] for part in mesh.parts]
    return Cutaway(
        parts=tuple(pack(surfaces) for surfaces in chunks(cut.mesh, cut.height_m)),
        section=section_of(groups, cut.height_m),
        height_m=cut.height_m,
    )


def send(scene: viser.SceneApi, cutaway: Cutaway) -> Iterator[viser.SceneNodeHandle]:
    """Add the parts as /scene/part0 and so on, the cut face as /scene/section."""
    for index, data in enumerate(cutaway.parts):
        yield scene.add_glb(f"/scene/part{index}", data, cast_shadow=False, receive_shadow=False)
    section = cutaway.section
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
        position=(section.centre_m[0], cutaway.height_m + 0.002, section.centre_m[1]),
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
    rows = {
        material: np.concatenate([np.arange(first, stop) for first, stop in spans])
        for material, spans in runs.items()
    }
    surfaces = [
        surface
        for material, own in rows.items()
        if (surface := surface_below(mesh, material, own, height_m)) is not None
    ]
    if surfaces:
        # As within a surface: the topmost first.
        yield sorted(surfaces, key=lambda one: -float(one.positions_m[:, 1].mean()))
