"""Which pictures may travel in a file that is made to be passed on."""

from __future__ import annotations

import re
from dataclasses import dataclass

from c2nav_engine.runner.record import Header

UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class LicenceRule:
    """When a scene counts as licensed [C]: renderings of it are derivatives and stay out.

    A scene is licensed when its id lies below one of `folders`, or when its licence says anything
    that is not known to be permissive. A scene that says nothing is not: it is the user's own.

    Attributes:
        folders: First parts of scene ids whose data sets forbid passing pictures on.
        permissive: Words of licences that allow it.
        forbidding: Words that take the permission back.
    """

    folders: tuple[str, ...] = ("mp3d", "hm3d", "gibson", "scannet")
    permissive: tuple[str, ...] = (
        r"CC0",
        r"PUBLIC DOMAIN",
        r"CC[ -]BY(?:[ -]SA)?",
        r"CREATIVE COMMONS ATTRIBUTION",
        r"MIT(?:-0)?",
        r"APACHE",
        r"BSD",
        r"ISC",
        r"UNLICENSE",
    )
    forbidding: tuple[str, ...] = (
        r"NC",
        r"ND",
        r"NON-?COMMERCIAL",
        r"NO-?DERIVATIVES",
        r"ALL RIGHTS RESERVED",
        r"PROPRIETARY",
        r"TERMS OF USE",
    )

    def licensed(self, header: Header) -> bool:
        """Whether pictures of this run's scene need a decision before they are passed on."""
        if header.episode.scene_id.partition("/")[0].lower() in self.folders:
            return True
        licence = header.scene_licence.upper().strip()
        if not licence:
            return False
        return _names(licence, self.forbidding) or not _names(licence, self.permissive)


def _names(licence: str, words: tuple[str, ...]) -> bool:
    return any(re.search(rf"(?<![A-Z]){word}(?![A-Z])", licence) for word in words)


def licence_words(header: Header) -> str:
    """The licence field, as it is printed."""
    return header.scene_licence or UNKNOWN
