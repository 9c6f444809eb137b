"""Seeing: elect one of the views that the controller vetted; nothing here moves."""

from c2nav_engine.faculties.seeing.election import gaze, glance, winner_of

__all__ = ["gaze", "glance", "winner_of"]
