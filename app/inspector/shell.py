"""viser's page as the shell: docks, layers, commands; drawn from snapshots on one thread."""

from __future__ import annotations

import contextlib
import io
import logging
import threading
import time

import viser

from app.inspector.palette import add_palette
from app.inspector.panels import (
    branches,
    decision,
    export,
    ladder,
    lookback,
    review,
    run,
    sketch,
    turning,
    view,
)
from app.inspector.panels.protocol import Build, Update
from app.inspector.scene.body import Body
from app.inspector.scene.cameras import Cameras
from app.inspector.scene.fan import Fan
from app.inspector.scene.floor import Floor
from app.inspector.scene.goal import Goal
from app.inspector.scene.layer import Layer
from app.inspector.scene.lookback import LookBack
from app.inspector.scene.mesh import Mesh
from app.inspector.scene.pin import Pin
from app.inspector.scene.trajectory import Trajectory
from app.inspector.scene.viewpoints import Viewpoints
from app.session.snapshot import Snapshot
from app.session.worker import Session

log = logging.getLogger(__name__)

_BLUE = (0x00, 0x72, 0xB2)
_REST_S = 0.06
_AT_LATEST_S = 1.0
"""The shell is drawn once nothing has changed for so long and the session is idle, or at the latest
so long after a change. The page's own strip and timeline come first; where the browser draws the
map without a GPU, each frame of it takes the cores that the next view is rendered with, and a
glance renders for a tenth of a second."""

LEFT_PX = 520
RIGHT_PX = 300


class Shell:
    """One viser server that shows one session."""

    def __init__(self, session: Session) -> None:
        """Start viser on a free loopback port, build the docks, follow the session."""
        self._session = session
        # viser prints its own address; ours is the gateway's.
        with contextlib.redirect_stdout(io.StringIO()):
            self._server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        self._updates: list[Update] = []
        self._layers: list[Layer] = []
        self._cameras = Cameras(self._server, lambda: session.snapshot)
        self._changed = threading.Event()
        self._closing = False
        self._dress()
        self._build_docks()
        self._build_scene()
        self._stop_following = session.subscribe(lambda _: self._changed.set())
        self._server.on_client_connect(self._cameras.greet)
        self._server.on_client_disconnect(self._cameras.forget)
        self._changed.set()
        self._mapped = threading.Event()
        self._painter = threading.Thread(target=self._paint, name="c2nav-paint", daemon=True)
        self._painter.start()
        threading.Thread(target=self._begin_map, name="c2nav-map", daemon=True).start()

    @property
    def port(self) -> int:
        """Where viser really listens: it moves silently to a free port."""
        return self._server.get_port()

    def close(self) -> None:
        """Stop drawing and close viser."""
        self._closing = True
        self._stop_following()
        self._changed.set()
        self._painter.join(timeout=5.0)
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()

    def _dress(self) -> None:
        gui, scene = self._server.gui, self._server.scene
        gui.configure_theme(show_logo=False, show_share_button=False, brand_color=_BLUE)
        scene.set_up_direction("+y")
        # Software WebGL has no time for reflections or shadows, and a plan needs neither.
        scene.configure_environment_map(hdri=None)
        scene.configure_default_lights(enabled=True, cast_shadow=False)
        scene.add_light_ambient("/ambient", intensity=0.8)
        scene.world_axes.visible = False

    def _build_docks(self) -> None:
        gui = self._server.gui
        left = gui.add_panel()
        self._fill(
            left,
            {
                "Decision": decision.build,
                "Look-back": lookback.build,
                "Sketch": sketch.build,
                "Ladder": ladder.build,
                "Turning": turning.build,
            },
        )
        left.dock_left()
        left.set_width(LEFT_PX)
        right = gui.add_panel()
        self._fill(
            right,
            {
                "Run": run.build,
                "Branches": branches.build,
                "Review": review.build,
                "Export": export.build,
            },
        )
        right.dock_right()
        right.set_width(RIGHT_PX)
        self._updates.append(view.build(gui, self._session.dispatch))
        gui.set_panel_label("Map")
        gui.main_panel.float(x=-12, y=-12)
        gui.main_panel.set_width(240)
        gui.main_panel.minimize()
        add_palette(gui, self._session.dispatch)

    def _fill(self, panel: viser.PanelHandle, builders: dict[str, Build]) -> None:
        for label, build in builders.items():
            with panel.add_tab(label):
                self._updates.append(build(self._server.gui, self._session.dispatch))

    def _build_scene(self) -> None:
        scene = self._server.scene
        self._layers = [
            Trajectory(scene),
            Body(scene),
            Fan(scene, self._session.dispatch),
            Goal(scene),
            Floor(scene),
            Viewpoints(scene),
            LookBack(scene),
            Pin(scene, self._session.dispatch),
            self._cameras,
            Mesh(
                scene,
                lambda: self._session.scene,
                self._server.atomic,
                self._session.first_page.sent,
            ),
        ]

    def _paint(self) -> None:
        while not self._closing:
            self._changed.wait()
            self._settle()
            if not self._closing:
                self.draw(self._session.snapshot)

    def _settle(self) -> None:
        """Wait until changes have come to rest, and take note of them."""
        latest_s = time.monotonic() + _AT_LATEST_S
        while not self._closing:
            self._changed.clear()
            left_s = latest_s - time.monotonic()
            changed = self._changed.wait(max(0.0, min(_REST_S, left_s)))
            if left_s <= 0.0 or not (changed or self._session.busy):
                return

    def _begin_map(self) -> None:
        """Drawing the map takes the page a second the first time: what can be read comes first."""
        self._session.first_page.wait()
        self._mapped.set()
        self._changed.set()

    def draw(self, snapshot: Snapshot) -> None:
        """Bring docks and map up to a snapshot; both wait for nothing but the page."""
        for update in self._updates:
            self._guarded(update, snapshot)
        if not self._mapped.is_set():
            return
        # All at once: the browser draws the map anew for every batch that arrives.
        with self._server.atomic():
            for layer in self._layers:
                self._guarded(layer.update, snapshot)

    def _guarded(self, update: Update, snapshot: Snapshot) -> None:
        """One broken panel must not stop the others."""
        try:
            update(snapshot)
        except Exception:
            log.exception("a part of the page could not be drawn")
