"""Poses, angles and cameras: the one place where frames and conventions are defined.

Right-handed, Y up, forward −Z, metres, radians; left is positive yaw; a position is the foot
point on the floor. This is the convention of Habitat and R2R-CE. Degrees appear only on screen.
"""

from c2nav_engine.geometry.angles import wrap_rad
from c2nav_engine.geometry.camera import Pinhole
from c2nav_engine.geometry.pose import Point, Pose, world_from_camera

__all__ = ["Pinhole", "Point", "Pose", "world_from_camera", "wrap_rad"]
