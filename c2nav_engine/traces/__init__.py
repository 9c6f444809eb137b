"""MCAP traces: schema, writer, reader, check, recover, exports."""
