"""The built-in houses: drawn as plans, furnished from seeds, textured, lit and walkable."""

from __future__ import annotations

from c2nav_engine.world.builtin.source import builtin_scene, builtin_source, house_names

__all__ = ["builtin_scene", "builtin_source", "house_names"]
