"""Every error this project raises on purpose, as one tree.

```
C2NavError                    anything below; carries one message fit for a person
├── InputError                the user's input cannot be used (exit code 2)
│   ├── UsageError            options that do not fit together, unknown names
│   ├── EpisodeError          an episode file or one of its fields
│   ├── SceneError            a scene that is missing, empty or unreadable
│   ├── NavMeshError          a `.navmesh` file that cannot be read
│   ├── StartError            a start or goal off the walkable surface
│   └── TraceError            a trace that is unreadable
│       └── UnfinishedTrace   a trace without its closing record
├── RankerError               a ranker that cannot go on (not: one bad answer, which is a value)
│   ├── RankerStopped         quota, refused connection, rejected key: the whole run stops
│   └── RankerUnavailable     retries are used up: this task ends as `error`, resumable
├── DivergenceError           a replay differs from its trace
├── MissingExtra              an optional package that the task needs (exit code 2)
└── InternalError             a broken promise between our own parts
```

A bad *answer* of a model is never an error: it is a value of `contract.outcome`.
Each message says what was expected, what came, and what to do next.
"""

from __future__ import annotations


class C2NavError(Exception):
    """Base of everything raised on purpose; `str(error)` is fit for a person."""


class InputError(C2NavError):
    """The user's input cannot be used as it is."""


class UsageError(InputError):
    """Options that do not fit together, or a name that does not exist."""


class EpisodeError(InputError):
    """An episode file, or one field of one episode, is wrong."""


class SceneError(InputError):
    """A scene file is missing, empty or unreadable."""


class NavMeshError(InputError):
    """A `.navmesh` file is not what its header promises."""


class StartError(InputError):
    """A start or goal does not lie on the walkable surface."""


class TraceError(InputError):
    """A trace cannot be read."""


class UnfinishedTrace(TraceError):
    """A trace lacks its closing record: the run was interrupted while writing it."""


class RankerError(C2NavError):
    """A ranker cannot go on; a single bad answer is a value instead."""


class RankerStopped(RankerError):
    """Quota used up, connection refused or key rejected: no further query makes sense."""


class RankerUnavailable(RankerError):
    """Retries are used up for one query: the task ends as `error` and can be resumed."""


class DivergenceError(C2NavError):
    """A replay did something else than its trace."""


class MissingExtra(C2NavError):
    """An optional package is needed; the message names the extra to install."""


class InternalError(C2NavError):
    """Two of our own parts broke their promise to each other: a bug."""
