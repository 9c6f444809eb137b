"""Consent that pictures leave this machine: asked once, kept in every trace that it covers."""

from __future__ import annotations

import datetime
import json
from dataclasses import dataclass

from app.session.opened import Run

CONSENT_FILE = "consent.json"
"""Name of the file inside a trace."""


@dataclass(frozen=True, slots=True)
class Consent:
    """A person's yes.

    Attributes:
        host: Where pictures may go.
        who: Who said so.
        at_s: When, seconds since the epoch.
    """

    host: str
    who: str
    at_s: float

    def keep(self, run: Run) -> None:
        """Attach it to the run's trace, with the licence that the pictures are under."""
        said = {
            "pictures_go_to": self.host,
            "scene_licence": run.header.scene_licence or "unknown",
            "allowed_by": self.who,
            "at": datetime.datetime.fromtimestamp(self.at_s, datetime.UTC).isoformat(),
        }
        run.keep(CONSENT_FILE, json.dumps(said, ensure_ascii=False, indent=1).encode())
