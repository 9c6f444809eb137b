"""A trace as newline-delimited JSON: one message a line, pictures by digest."""

from __future__ import annotations

import json
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from google.protobuf.json_format import MessageToDict

from c2nav_engine.traces.moments import parsed
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.records import Stored


def export_ndjson(trace: TraceFile, out: Path) -> int:
    """Write the trace's facts as the first line, then every message; returns the lines written."""
    count = 0
    with out.open("w", encoding="utf-8", newline="\n") as file:
        for line in ndjson_lines(trace):
            file.write(line + "\n")
            count += 1
    return count


def ndjson_lines(trace: TraceFile) -> Iterator[str]:
    """The lines without their ends, keys as in the schema; `wall` fields are kept."""
    yield json.dumps({"metadata": {"sha256": trace.sha256, **trace.facts}}, ensure_ascii=False)
    for stored in trace.messages():
        line = {
            "topic": stored.topic,
            "sequence": stored.sequence,
            "log_time_ns": stored.log_time_ns,
            "message": _plain(stored),
        }
        yield json.dumps(line, ensure_ascii=False)


def _plain(stored: Stored) -> object:
    message = parsed(stored)
    if isinstance(message, CompressedImage):
        data = message.data
        return {
            "frame_id": message.frame_id,
            "format": message.format,
            "bytes": len(data),
            "sha256": sha256(data).hexdigest(),
        }
    return MessageToDict(message, preserving_proto_field_name=True)
