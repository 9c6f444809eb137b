"""Arriving: staged evidence, a fixed ladder, and a look back before anything irreversible."""

from c2nav_engine.faculties.arriving.evidence import (
    Reading,
    evaluate,
    evaluate_absolute,
    evaluate_basic,
    sign,
)
from c2nav_engine.faculties.arriving.ladder import LADDER, Evidence, Verdict, verdict_of

__all__ = [
    "LADDER",
    "Evidence",
    "Reading",
    "Verdict",
    "evaluate",
    "evaluate_absolute",
    "evaluate_basic",
    "sign",
    "verdict_of",
]
