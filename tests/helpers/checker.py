"""The run-time type checker of the tests: beartype, with Python's numeric tower.

A parameter annotated `float` takes an `int`, as PEP 484 says and pyright holds.
"""

from __future__ import annotations

from beartype import BeartypeConf, beartype

checked = beartype(conf=BeartypeConf(is_pep484_tower=True))
