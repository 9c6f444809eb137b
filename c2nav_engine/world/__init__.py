"""Scenes, walkable surfaces, geodesics, kinematics, built-in houses."""
