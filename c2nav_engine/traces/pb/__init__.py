"""Message schemas: `*.proto` are the source, `*_pb2.py` are generated from them.

Regenerate with `python -m c2nav_engine.traces.generate`; a test fails when they are stale.
Fields are only ever added: a number once used keeps its meaning for good.
"""
