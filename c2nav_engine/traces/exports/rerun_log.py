"""Logs a trace with Rerun's own archetypes, in the frames of geometry/ (Rerun converts nothing).

By the timelines `step` and `exchange`; converting the MCAP instead would lose both, and the depth.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Point, Pose, world_from_camera
from c2nav_engine.traces.attachments import Task
from c2nav_engine.traces.contract_messages import pose_of
from c2nav_engine.traces.exports.pages import decision_markdown, ladder_markdown
from c2nav_engine.traces.moments import Moment, moments, pictures
from c2nav_engine.traces.pb.control_pb2 import Control
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.route_pb2 import Ladder, Sketch
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.words import committed_words, winner_of
from c2nav_engine.world.scene import Scene

ELECTED_RGB = (84, 190, 128)
OFFERED_RGB = (150, 152, 158)
VETOED_RGB = (196, 88, 80)
GOAL_RGB = (236, 190, 84)

ABOVE_FLOOR_M = 0.06
"""Lines are lifted off the floor so that it does not hide them."""

HEADROOM_M = 1.9
"""What begins higher than this above the way, ceilings and upper floors, is not drawn."""

Rerun = Any
"""The `rerun` module or a recording of it: its types are partial."""


class RerunLog:
    """One trace below one root of a recording.

    Args:
        rr: The rerun module.
        recording: Where to log.
        root: "" or "/run_a": stands before every entity.
        colour: Of the trail and the body, to tell two runs apart.
    """

    def __init__(
        self, rr: Rerun, recording: Rerun, *, root: str = "", colour: tuple[int, int, int]
    ) -> None:
        self._rr = rr
        self._recording = recording
        self._root = root
        self._colour = colour
        self._trail: list[Point] = []
        self._top_m = -math.inf

    def log(self, trace: TraceFile, task: Task) -> None:
        """Everything in the trace."""
        self._task(task)
        for moment in moments(trace):
            self._recording.set_time("step", sequence=moment.step)
            self._recording.set_time("exchange", sequence=moment.exchange)
            self._moment(trace, task.profile, moment)
        self._recording.reset_time()

    def scene(self, scene: Scene) -> None:
        """The mesh as a doll's house, one entity per material; after `log`, which knows the way."""
        rr = self._rr
        lowest_m = scene.vertices_m[scene.triangles, 1].min(axis=1)
        kept = lowest_m < self._top_m + HEADROOM_M
        for index, material in enumerate(scene.materials):
            runs = [part for part in scene.parts if part.material == index]
            chosen = np.concatenate(
                [np.arange(0), *(np.arange(part.first, part.stop) for part in runs)]
            )
            chosen = chosen[kept[chosen]]
            if not len(chosen):
                continue
            corners = scene.triangles[chosen].reshape(-1)
            texcoords = texture = None
            if scene.uvs is not None and material.texture is not None:
                # Rerun counts texture rows from the top.
                texcoords = scene.uvs[chosen].reshape(-1, 2) * [1.0, -1.0] + [0.0, 1.0]
                texture = np.ascontiguousarray(material.texture[..., :3])
            mesh = rr.Mesh3D(
                vertex_positions=scene.vertices_m[corners],
                triangle_indices=np.arange(len(corners)).reshape(-1, 3),
                vertex_colors=None if scene.colours is None else scene.colours[corners],
                vertex_texcoords=texcoords,
                albedo_texture=texture,
                albedo_factor=[_srgb(channel) for channel in material.colour[:3]],
            )
            self._static(f"world/mesh/{index}", mesh)

    # ------------------------------------------------------------ once

    def _task(self, task: Task) -> None:
        rr, episode = self._rr, task.episode
        self._static("world", rr.ViewCoordinates.RIGHT_HAND_Y_UP)
        legs = "\n".join(f"{number}. {leg}" for number, leg in enumerate(task.legs, 1))
        text = f"**{episode.instruction}**\n\n{legs}"
        self._static("instruction", rr.TextDocument(text, media_type=rr.MediaType.MARKDOWN))
        if episode.reference_path_m:
            path = [(x, y + ABOVE_FLOOR_M, z) for x, y, z in episode.reference_path_m]
            strip = rr.LineStrips3D([path], colors=OFFERED_RGB, radii=0.02)
            self._static("world/reference", strip)
        if episode.goal_m is not None:
            radius_m = episode.goal_radius_m
            x, y, z = episode.goal_m
            ring = [
                (x + radius_m * math.cos(a), y + ABOVE_FLOOR_M, z + radius_m * math.sin(a))
                for a in np.linspace(0.0, math.tau, 49)
            ]
            self._static("world/goal", rr.Points3D([(x, y, z)], colors=GOAL_RGB, radii=0.1))
            strip = rr.LineStrips3D([ring], colors=GOAL_RGB, radii=0.015)
            self._static("world/goal/reach", strip)

    # ------------------------------------------------------------ each moment

    def _moment(self, trace: TraceFile, profile: Profile, moment: Moment) -> None:
        self._poses(moment)
        message = moment.message
        if isinstance(message, Decision):
            self._decision(message, pictures(trace, message))
        elif isinstance(message, Sketch):
            words = f"**{message.words}** · cue {message.cue}\n\n{message.rendering}"
            self._text("sketch", words)
            self._put("log", self._rr.TextLog(f"sketch: {message.words} ({message.cue})"))
        elif isinstance(message, Ladder):
            self._ladder(message)
        else:
            self._control(trace, profile, moment, message)

    def _poses(self, moment: Moment) -> None:
        rr = self._rr
        for step, pose in moment.poses():
            self._recording.set_time("step", sequence=step)
            x, y, z = pose.position_m
            self._trail.append((x, y + ABOVE_FLOOR_M, z))
            self._top_m = max(self._top_m, y)
            arrow = rr.Arrows3D(
                origins=[(x, y + ABOVE_FLOOR_M, z)],
                vectors=[tuple(0.4 * part for part in pose.forward)],
                colors=self._colour,
            )
            self._put("world/body", arrow)
        if moment.poses():
            trail = rr.LineStrips3D([self._trail], colors=self._colour, radii=0.04)
            self._put("world/trail", trail)
        for step, distance_m in moment.goal_distances_m():
            self._recording.set_time("step", sequence=step)
            if math.isfinite(distance_m):
                self._put("goal_distance_m", rr.Scalars(distance_m))

    def _control(
        self, trace: TraceFile, profile: Profile, moment: Moment, control: Control
    ) -> None:
        what = control.WhichOneof("what")
        if what == "look":
            self._look(trace, profile, moment, control)
        elif what == "event":
            level = "WARN" if control.event.name in ("fallback", "stalled") else "INFO"
            words = f"{control.event.name}: {control.event.detail}"
            self._put("log", self._rr.TextLog(words, level=level))
        elif what == "stop":
            self._put("log", self._rr.TextLog("STOP"))

    def _look(self, trace: TraceFile, profile: Profile, moment: Moment, control: Control) -> None:
        held = pictures(trace, control)
        _, pose = moment.poses()[0]
        if not control.look.sectors:
            for view in control.look.views:
                self._camera(profile, pose, f"world/camera/{view.key}", offset_rad=view.offset_rad)
                self._image(f"world/camera/{view.key}/image", held[view.picture])
        for place, sector in enumerate(control.look.sectors):
            self._image(f"glance/{place}", held[sector])
        if moment.evaluation is not None and moment.evaluation.depth:
            depth = pictures(trace, moment.evaluation)[moment.evaluation.depth]
            self._camera(profile, pose, "world/depth/front", depth=True)
            self._depth("world/depth/front/image", depth)

    def _camera(
        self,
        profile: Profile,
        pose: Pose,
        entity: str,
        *,
        offset_rad: float = 0.0,
        depth: bool = False,
    ) -> None:
        rr = self._rr
        pinhole = profile.depth if depth else profile.rgb
        there = world_from_camera(pose, height_m=profile.camera_height_m, offset_rad=offset_rad)
        self._put(entity, rr.Transform3D(translation=there[:3, 3], mat3x3=there[:3, :3]))
        lens = rr.Pinhole(
            focal_length=pinhole.focal_px,
            width=pinhole.width_px,
            height=pinhole.height_px,
            camera_xyz=rr.ViewCoordinates.RUB,
            image_plane_distance=0.5,
        )
        self._put(entity, lens)

    def _image(self, entity: str, jpeg: bytes) -> None:
        if jpeg:
            self._put(entity, self._rr.EncodedImage(contents=jpeg, media_type="image/jpeg"))

    def _depth(self, entity: str, png: bytes) -> None:
        if png:
            image = self._rr.EncodedDepthImage(blob=png, media_type="image/png", meter=1000.0)
            self._put(entity, image)

    # ------------------------------------------------------------ decisions

    def _decision(self, decision: Decision, held: dict[str, bytes]) -> None:
        self._text("decision", decision_markdown(decision))
        level = "INFO" if winner_of(decision) else "WARN"
        words = f"decision {decision.decision}, {decision.slot}: {committed_words(decision)}"
        self._put("log", self._rr.TextLog(words, level=level))
        self._candidates(decision)
        if decision.slot == "lookback":
            for each in decision.question.alternatives:
                self._image(f"lookback/{each.key}", held.get(each.picture, b""))

    def _candidates(self, decision: Decision) -> None:
        """Each candidate's direction, as long as its free space, coloured by its fate."""
        pose = pose_of(decision.facts.odometry)
        winner = winner_of(decision)
        arrows = [each for each in decision.facts.candidates if each.HasField("offset_rad")]
        colours = [
            ELECTED_RGB if each.key == winner else OFFERED_RGB if each.feasible else VETOED_RGB
            for each in arrows
        ]
        vectors = [
            tuple(max(each.free_m, 0.1) * part for part in pose.turned(each.offset_rad).forward)
            for each in arrows
        ]
        x, y, z = pose.position_m
        self._put(
            "world/candidates",
            self._rr.Arrows3D(
                origins=[(x, y + ABOVE_FLOOR_M, z)] * len(arrows),
                vectors=vectors or np.zeros((0, 3)),
                colors=colours or None,
                labels=[each.key for each in arrows] or None,
            ),
        )

    def _ladder(self, ladder: Ladder) -> None:
        evidence = (ladder.ground, ladder.journey, ladder.lookback)
        for name, value in zip(("ground", "journey", "lookback"), evidence, strict=True):
            self._put(f"ladder/{name}", self._rr.Scalars(value))
        self._text("ladder/verdict", ladder_markdown(ladder))

    # ------------------------------------------------------------ entities

    def _text(self, entity: str, markdown: str) -> None:
        rr = self._rr
        self._put(entity, rr.TextDocument(markdown, media_type=rr.MediaType.MARKDOWN))

    def _put(self, entity: str, archetype: Any) -> None:
        self._recording.log(f"{self._root}/{entity}", archetype)

    def _static(self, entity: str, archetype: Any) -> None:
        self._recording.log(f"{self._root}/{entity}", archetype, static=True)


def _srgb(linear: float) -> float:
    """GlTF factors are linear, Rerun's are sRGB."""
    value = min(max(linear, 0.0), 1.0)
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
