"""What Foxglove and other viewers draw: images, poses, transforms, the camera, log lines.

Viewers expect z up and cameras that look along +z. This is the edge where that is converted; our
own messages keep the frames of geometry/. Foxglove's world frame: x = −Z (ahead at yaw 0), y = −X
(left), z = Y (up), so that yaw is the same angle about the vertical.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from foxglove_schemas_protobuf.CameraCalibration_pb2 import CameraCalibration
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.Pose_pb2 import Pose as FoxglovePose
from foxglove_schemas_protobuf.PoseInFrame_pb2 import PoseInFrame
from foxglove_schemas_protobuf.PosesInFrame_pb2 import PosesInFrame
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Point, Pose

WORLD = "world"
BODY = "body"
PATH_POSES = 64
"""`/path` carries the last poses only: a growing path would make the file quadratic."""


def timestamp(time_ns: int) -> Timestamp:
    """A log time as protobuf has it."""
    seconds, nanos = divmod(time_ns, 1_000_000_000)
    return Timestamp(seconds=seconds, nanos=nanos)


def viewer_position(point_m: Point) -> Vector3:
    """A world point in the viewer's frame."""
    x, y, z = point_m
    return Vector3(x=-z, y=-x, z=y)


def viewer_pose(pose: Pose) -> FoxglovePose:
    """A body pose in the viewer's frame: x ahead, y left, z up."""
    half_rad = pose.yaw_rad / 2.0
    return FoxglovePose(
        position=viewer_position(pose.position_m),
        orientation=Quaternion(x=0.0, y=0.0, z=math.sin(half_rad), w=math.cos(half_rad)),
    )


def image_message(data: bytes, *, frame: str, kind: str, time_ns: int) -> CompressedImage:
    """An encoded image; `kind` is jpeg or png."""
    return CompressedImage(timestamp=timestamp(time_ns), frame_id=frame, data=data, format=kind)


def camera_frame(key: str) -> str:
    """Frame of a camera's optical axis."""
    return f"camera_{key}"


def pose_in_world(pose: Pose, time_ns: int) -> PoseInFrame:
    """The body's pose for `/pose`."""
    return PoseInFrame(timestamp=timestamp(time_ns), frame_id=WORLD, pose=viewer_pose(pose))


def path_in_world(poses: Sequence[Pose], time_ns: int) -> PosesInFrame:
    """The last poses for `/path`."""
    return PosesInFrame(
        timestamp=timestamp(time_ns),
        frame_id=WORLD,
        poses=[viewer_pose(pose) for pose in poses[-PATH_POSES:]],
    )


def body_transform(pose: Pose, time_ns: int) -> FrameTransforms:
    """Where the body stands, for `/tf`."""
    there = viewer_pose(pose)
    return FrameTransforms(
        transforms=[
            FrameTransform(
                timestamp=timestamp(time_ns),
                parent_frame_id=WORLD,
                child_frame_id=BODY,
                translation=viewer_position(pose.position_m),
                rotation=there.orientation,
            )
        ]
    )


def camera_transforms(profile: Profile, time_ns: int) -> FrameTransforms:
    """The fan's cameras on the body; their frames look along +z with x right and y down."""
    offsets_rad = {
        "left": profile.fan_offset_rad,
        "front": 0.0,
        "right": -profile.fan_offset_rad,
    }
    return FrameTransforms(
        transforms=[
            FrameTransform(
                timestamp=timestamp(time_ns),
                parent_frame_id=BODY,
                child_frame_id=camera_frame(key),
                translation=Vector3(x=0.0, y=0.0, z=profile.camera_height_m),
                rotation=_optical_rotation(offset_rad),
            )
            for key, offset_rad in offsets_rad.items()
        ]
    )


def _optical_rotation(yaw_rad: float) -> Quaternion:
    """Body from optical frame: turn by the yaw about z, then (x, y, z) ↦ (z, −x, −y)."""
    # The fixed part is (−½, ½, −½, ½) as (x, y, z, w); multiply the yaw quaternion from the left.
    sin, cos = math.sin(yaw_rad / 2.0), math.cos(yaw_rad / 2.0)
    return Quaternion(
        x=-0.5 * cos - 0.5 * sin,
        y=0.5 * cos - 0.5 * sin,
        z=-0.5 * cos + 0.5 * sin,
        w=0.5 * cos + 0.5 * sin,
    )


def calibration_message(profile: Profile, time_ns: int) -> CameraCalibration:
    """The front camera's pinhole."""
    rgb = profile.rgb
    f, cx, cy = rgb.focal_px, rgb.width_px / 2.0, rgb.height_px / 2.0
    return CameraCalibration(
        timestamp=timestamp(time_ns),
        frame_id=camera_frame("front"),
        width=rgb.width_px,
        height=rgb.height_px,
        distortion_model="plumb_bob",
        D=[0.0] * 5,
        K=[f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0],
        R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P=[f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    )


def log_line(name: str, text: str, *, time_ns: int, warning: bool = False) -> Log:
    """A line for `/log`."""
    level = Log.Level.WARNING if warning else Log.Level.INFO
    return Log(timestamp=timestamp(time_ns), level=level, message=text, name=name)
