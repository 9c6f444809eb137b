"""Furniture from simple solids, one maker per kind of thing.

A model stands on the floor at the origin of its own frame, its back towards −z, its front
towards +z; `catalogue` lists every maker by the noun that instructions use.
"""
