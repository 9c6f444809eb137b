"""The run-time type checker of the tests: beartype, with Python's numeric tower.

A parameter annotated `float` takes an `int`, as PEP 484 says and pyright holds.
"""

from __future__ import annotations

import random
from unittest import mock

# A check looks at one item of a list by chance. Hypothesis wants the common generator left alone
# while it draws, and a background thread of an earlier test may be checked just then; so checks get
# one of their own, which beartype takes when it is imported.
with mock.patch.object(random, "getrandbits", random.Random(0).getrandbits):
    from beartype import BeartypeConf, beartype

checked = beartype(conf=BeartypeConf(is_pep484_tower=True))
