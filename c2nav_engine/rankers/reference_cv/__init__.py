"""A ranker of pixels and text by OpenCV: the embedded default, and not a model."""

from c2nav_engine.rankers.reference_cv.adapter import ReferenceCv

__all__ = ["ReferenceCv"]
