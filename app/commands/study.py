"""`c2nav study`: a frozen set of decisions that people judge blind."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, words
from app.commands.output import check_file, check_folder, print_json
from app.reviews.study import add_person as add_to
from app.reviews.study import make_study, read_study

RunArg = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="RUN")]
NameOpt = Annotated[str, tyro.conf.arg(metavar="NAME", help="The study's name.")]
_LINK = "http://127.0.0.1:8080/judge"


def make(
    runs: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="RUN…")],
    name: NameOpt,
    per_slot: Annotated[int, tyro.conf.arg(metavar="N", help="Decisions of each slot.")] = 67,
    seed: Annotated[int, tyro.conf.arg(help="Of the draw and of every person's order.")] = 0,
    repeat: Annotated[
        float, tyro.conf.arg(help="Share of items that come twice, from 0 to 1.")
    ] = 0.1,
    people: Annotated[str, tyro.conf.arg(metavar="A,B", help="People to add at once.")] = "",
    json: JsonOpt = False,
) -> int:
    """Freeze decisions in RUN/studies/NAME: even over slots, at most three an episode."""
    study = make_study(runs, name=name, per_slot=per_slot, seed=seed, repeat=repeat)
    slots = dict(sorted(Counter(item.slot for item in study.items).items()))
    links = [(person, _link(add_to(study, person)[1])) for person in words(people)]
    if json:
        print_json(
            {
                "study": str(study.folder),
                "sha256": study.sha256,
                "items": len(study.items),
                "repeats": len(study.repeats),
                "slots": slots,
                "people": [{"name": person, "link": link} for person, link in links],
            }
        )
        return 0
    console = Console(highlight=False)
    console.print(f"{len(study.items)} decisions, {len(study.repeats)} of them twice", markup=False)
    for slot, count in slots.items():
        short = "" if count >= per_slot else f" (of {per_slot} wanted)"
        console.print(f"  {slot}: {count}{short}", markup=False)
    for person, link in links:
        console.print(f"{person}: {link}", markup=False, soft_wrap=True)
    console.print(f"frozen in {study.folder}", markup=False, soft_wrap=True)
    return 0


def add_person(
    run: RunArg,
    name: NameOpt,
    person: Annotated[str, tyro.conf.arg(metavar="PERSON", help="Who judges.")],
    queue: Annotated[
        str, tyro.conf.arg(help="Share this queue with others; by default their own.")
    ] = "",
    at: Annotated[str, tyro.conf.arg(metavar="URL", help="Where the page is served.")] = _LINK,
    json: JsonOpt = False,
) -> int:
    """Give somebody a personal link; the same person again gets a new link and keeps everything."""
    added, token = add_to(read_study(run, name), person, queue=queue)
    link = _link(token, at)
    if json:
        print_json({"person": added.name, "pseudonym": added.pseudonym, "link": link})
    else:
        Console(highlight=False).print(f"{added.name}: {link}", markup=False, soft_wrap=True)
    return 0


def status(run: RunArg, name: NameOpt, json: JsonOpt = False) -> int:
    """Who has answered how much."""
    from app.reviews.desk import Desk

    study = read_study(run, name)
    desk = Desk(study)
    try:
        progress = desk.progress()
    finally:
        desk.close()
    people = [
        {
            "name": person.name,
            "pseudonym": person.pseudonym,
            "queue": person.queue,
            "answered": progress[person.queue][0],
            "places": progress[person.queue][1],
        }
        for person in study.people()
    ]
    if json:
        print_json({"study": name, "items": len(study.items), "people": people})
        return 0
    console = Console(highlight=False)
    for each in people:
        console.print(
            f"{each['name']} ({each['pseudonym']}): {each['answered']} of {each['places']}",
            markup=False,
        )
    return 0


def pack(
    run: RunArg,
    name: NameOpt,
    out: Annotated[Path, tyro.conf.arg(metavar="DIR", help="Where the pages are written.")],
    person: Annotated[str, tyro.conf.arg(help="Only for this person.")] = "",
    json: JsonOpt = False,
) -> int:
    """Write one page a person that judges from a file, without any network."""
    from app.commands.packing import pack_study

    check_folder(out)
    written = pack_study(read_study(run, name), out=out, only=person)
    if json:
        print_json({"packed": {each: str(path) for each, path in written.items()}})
        return 0
    console = Console(highlight=False)
    for each, path in written.items():
        size = path.stat().st_size / 1e6
        console.print(f"{each}: {path} ({size:.1f} MB)", markup=False, soft_wrap=True)
    return 0


def import_(
    run: RunArg,
    files: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="FILE.jsonl…")],
    name: NameOpt,
    json: JsonOpt = False,
) -> int:
    """Take in answers that were given elsewhere; a file is taken whole or refused."""
    from app.reviews.importing import import_answers
    from app.reviews.packed import is_packed, packed_events
    from app.reviews.store import read_lines, store_of

    study = read_study(run, name)
    taken: dict[str, int] = {}
    with store_of(study.run) as store:
        for path in files:
            lines = _lines(path)
            read = packed_events(study, lines, where=str(path)) if is_packed(lines) else None
            events = read_lines(lines, where=str(path)) if read is None else read
            taken[str(path)] = import_answers(study, store, events, where=str(path))
    if json:
        print_json({"imported": taken})
    else:
        for path, count in taken.items():
            Console(highlight=False).print(f"{path}: {count} events", markup=False)
    return 0


def export(
    run: RunArg,
    out: Annotated[Path, tyro.conf.arg(metavar="FILE.jsonl")],
    names: Annotated[bool, tyro.conf.arg(help="Real names instead of pseudonyms.")] = False,
    json: JsonOpt = False,
) -> int:
    """Write everything that people said about a run as lines of JSON."""
    from app.reviews.store import FILE, export_lines, store_of

    check_file(out, run / FILE)
    with store_of(run) as store:
        lines = export_lines(store, names=names)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    if json:
        print_json({"out": str(out), "events": len(lines)})
    else:
        Console(highlight=False).print(f"{out}: {len(lines)} events", markup=False)
    return 0


def serve(
    run: RunArg,
    name: NameOpt,
    host: Annotated[str, tyro.conf.arg(help="Address to bind.")] = "127.0.0.1",
    port: Annotated[int, tyro.conf.arg(help="Port to bind; 0 takes a free one.")] = 8080,
) -> int:
    """Serve the judging page alone, until interrupted."""
    from app.gateway.judging import desks_of, serve_judging

    console = Console(highlight=False)
    serve_judging(
        desks_of([run], name=name),
        host=host,
        port=port,
        ready=lambda url: console.print(f"judging at {url}?token=…", markup=False),
    )
    return 0


def _link(token: str, at: str = _LINK) -> str:
    return f"{at}?token={token}"


def _lines(path: Path) -> list[str]:
    from c2nav_engine.errors import UsageError

    try:
        return path.read_text("utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        message = f"expected a file of answers at {path}, came none that can be read ({error})"
        raise UsageError(message) from None


study = {
    "make": make,
    "add-person": add_person,
    "status": status,
    "pack": pack,
    "serve": serve,
    "export": export,
    "import": import_,
}
"""Subcommands of `c2nav study`."""
