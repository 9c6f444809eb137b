"""What people add to the index: manual tags, saved views, named sets with captions."""

from __future__ import annotations

import re
from dataclasses import dataclass

from app.pages.index.finding import Case, case_of
from app.pages.index.query import Query
from app.pages.index.store import Store
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.tags.rules import TAGS

_NAME = re.compile(r"[\w][\w .+-]{0,59}")


@dataclass(frozen=True, slots=True)
class View:
    """A saved query."""

    name: str
    query: Query


@dataclass(frozen=True, slots=True)
class CaseSet:
    """A named set of episodes.

    Attributes:
        name: Also the folder of its export.
        note: What it is about.
        size: Episodes in it.
    """

    name: str
    note: str
    size: int


def mark(store: Store, sha256: str, tag: str, *, on: bool) -> None:
    """Set or take off a manual tag; raises `InputError` for a name that is an automatic one."""
    if tag in TAGS:
        message = f"{tag} is an automatic tag: its rule sets it; choose another name"
        raise InputError(message)
    check_name(tag, "a tag")
    if on and case_of(store, sha256) is None:
        message = f"expected the digest of an indexed trace, came {sha256[:12]!r}"
        raise InputError(message)
    sql = "insert or ignore into marks values (?, ?)"
    if not on:
        sql = "delete from marks where trace_sha256 = ? and tag = ?"
    with store.writing() as db:
        db.execute(sql, (sha256, tag))


def marks(store: Store) -> list[tuple[str, int]]:
    """Manual tags in use with how many episodes have them."""
    found = store.read("select tag, count(*) from marks group by tag order by tag")
    return [(tag, count) for tag, count in found]


def save_view(store: Store, name: str, query: Query) -> None:
    """Keep a query under a name, replacing an earlier one; raises `InputError` for a bad one."""
    check_name(name, "a view")
    query.where()
    query.order()
    with store.writing() as db:
        db.execute("insert or replace into views values (?, ?, ?)", (name, query.text, query.sort))


def drop_view(store: Store, name: str) -> None:
    """Forget a saved view."""
    with store.writing() as db:
        db.execute("delete from views where name = ?", (name,))


def views(store: Store) -> list[View]:
    """All saved views by name."""
    found = store.read("select name, query, sort from views order by name")
    return [View(name, Query(text, sort)) for name, text, sort in found]


def put_in_set(store: Store, name: str, sha256: str, *, caption: str | None = None) -> None:
    """Add an episode to a set, which is made where there is none; raises `InputError`.

    Args:
        store: The index.
        name: The set.
        sha256: Digest of the episode's trace.
        caption: What the set says of it; None keeps what it says.
    """
    check_name(name, "a set")
    if case_of(store, sha256) is None:
        message = f"expected the digest of an indexed trace, came {sha256[:12]!r}"
        raise InputError(message)
    with store.writing() as db:
        db.execute("insert or ignore into sets (name) values (?)", (name,))
        db.execute(
            "insert or ignore into members (name, trace_sha256, place) values "
            "(?, ?, (select ifnull(max(place), -1) + 1 from members where name = ?))",
            (name, sha256, name),
        )
        if caption is not None:
            db.execute(
                "update members set caption = ? where name = ? and trace_sha256 = ?",
                (caption, name, sha256),
            )


def take_from_set(store: Store, name: str, sha256: str) -> None:
    """Take an episode out; a set without episodes is gone."""
    with store.writing() as db:
        db.execute("delete from members where name = ? and trace_sha256 = ?", (name, sha256))
        db.execute("delete from sets where name not in (select name from members)")


def describe_set(store: Store, name: str, note: str) -> None:
    """Say what a set is about."""
    with store.writing() as db:
        db.execute("update sets set note = ? where name = ?", (note, name))


def sets(store: Store) -> list[CaseSet]:
    """All sets by name."""
    found = store.read(
        "select name, note, (select count(*) from members where members.name = sets.name) "
        "from sets order by name"
    )
    return [CaseSet(*row) for row in found]


def set_named(store: Store, name: str) -> CaseSet:
    """A set; raises `InputError` where there is none of that name."""
    found = [each for each in sets(store) if each.name == name]
    if not found:
        known = ", ".join(each.name for each in sets(store)) or "none"
        message = f"expected a set of this folder ({known}), came {name!r}"
        raise InputError(message)
    return found[0]


def members(store: Store, name: str) -> list[tuple[Case | None, str, str]]:
    """(case, digest, caption) of a set's episodes in order; no case where its trace is gone."""
    set_named(store, name)
    found = store.read(
        "select trace_sha256, caption from members where name = ? order by place", (name,)
    )
    return [(case_of(store, sha256), sha256, caption) for sha256, caption in found]


def check_name(name: str, what: str) -> None:
    """Raise `InputError` unless a name can be kept, and be the name of a folder."""
    if not _NAME.fullmatch(name):
        message = (
            f"expected a name for {what} of letters, digits, spaces and . + - _, at most 60 long, "
            f"came {name!r}"
        )
        raise InputError(message)
