"""Traces in other people's formats, and traces made from traces. None of these needs a scene."""

from c2nav_engine.traces.exports.derived import Review, export_merged, export_redacted, reviews_of
from c2nav_engine.traces.exports.ndjson import export_ndjson
from c2nav_engine.traces.exports.rerun_file import export_rrd
from c2nav_engine.traces.exports.tables import export_parquet
from c2nav_engine.traces.exports.video import VideoStyle, export_video

__all__ = [
    "Review",
    "VideoStyle",
    "export_merged",
    "export_ndjson",
    "export_parquet",
    "export_redacted",
    "export_rrd",
    "export_video",
    "reviews_of",
]
