"""MCAP traces: schema, writer, reader, check, recover, exports."""

from c2nav_engine.traces.check import Fault, check
from c2nav_engine.traces.equality import Difference, first_difference
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.recover import Recovered, recover
from c2nav_engine.traces.topics import SCHEMA_VERSION

__all__ = [
    "SCHEMA_VERSION",
    "Difference",
    "Fault",
    "Recovered",
    "TraceFile",
    "check",
    "first_difference",
    "recover",
]
