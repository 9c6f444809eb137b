"""Header and footer of a run as a trace's metadata and attachments, and back."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping

from pydantic import TypeAdapter, ValidationError

from c2nav_engine.errors import TraceError
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header
from c2nav_engine.traces.attachments import (
    CONFIG_FILE,
    EPISODE_FILE,
    HEADER_FILE,
    TEMPLATE_FOLDER,
)
from c2nav_engine.traces.topics import SCHEMA_VERSION

_HEADER = TypeAdapter(Header)
_METRICS = TypeAdapter(dict[str, int | float | str | None])


def header_files(header: Header) -> dict[str, bytes]:
    """The header as attached files, each of its parts once."""
    plain = dataclasses.asdict(header)
    config, episode = plain.pop("config"), plain.pop("episode")
    templates: dict[str, str] = plain.pop("templates")
    return {
        HEADER_FILE: _json(plain),
        CONFIG_FILE: _json(config),
        EPISODE_FILE: _json(episode),
        **{f"{TEMPLATE_FOLDER}{name}": text.encode() for name, text in templates.items()},
    }


def header_of(files: Mapping[str, bytes]) -> Header:
    """The header of a trace's attached files; raises `TraceError` naming a wrong field."""
    try:
        plain = json.loads(files[HEADER_FILE])
        plain["config"] = json.loads(files[CONFIG_FILE])
        plain["episode"] = json.loads(files[EPISODE_FILE])
        plain["templates"] = {
            name.removeprefix(TEMPLATE_FOLDER): data.decode()
            for name, data in files.items()
            if name.startswith(TEMPLATE_FOLDER)
        }
        return _HEADER.validate_python(plain)
    except (KeyError, ValueError, ValidationError) as error:
        message = f"expected the header of a run in the trace's attachments, came {error}"
        raise TraceError(message) from error


def header_facts(header: Header) -> dict[str, str]:
    """What a file browser shows of a run: flat text by name."""
    episode = header.episode
    return {
        "schema_version": str(SCHEMA_VERSION),
        "run": header.run,
        "episode": episode.episode_id,
        "scene": episode.scene_id,
        "variant": header.variant,
        "profile": header.profile.name,
        "ranker": header.ranker,
        "privileged": _word(header.privileged),
        "seed": str(header.seed),
        "config_sha256": header.config_sha256,
        "code_version": header.code_version,
        "parser": header.parser,
        "surface": header.surface,
        "headings": header.headings,
        "licence": header.scene_licence,
        "parent_sha256": header.parent_sha256,
        "fork_decision": "" if header.fork_decision < 0 else str(header.fork_decision),
        "complete": "no",
    }


def footer_facts(footer: Footer) -> dict[str, str]:
    """What joins the facts when a run is over."""
    metrics = {name: _portable(value) for name, value in footer.metrics.items()}
    return {
        "complete": "yes",
        "outcome": footer.outcome,
        "error": footer.error,
        "metrics": json.dumps(metrics),
    }


def footer_of(facts: Mapping[str, str]) -> Footer:
    """The footer of a trace's facts; of a recovered one, `interrupted` without metrics.

    Raises:
        TraceError: A fact makes no sense, as after damage.
    """
    try:
        outcome = EpisodeOutcome(facts.get("outcome", "interrupted"))
        metrics = _METRICS.validate_json(facts.get("metrics", "{}"))
        plain = {name: _number(value) for name, value in metrics.items()}
    except ValueError as error:
        came = " ".join(str(error).split())
        message = (
            f"damaged trace: expected an outcome and metrics in its closing record, came {came}; "
            "`c2nav trace recover` saves what is intact"
        )
        raise TraceError(message) from error
    return Footer(outcome, plain, facts.get("error", ""))


def _json(value: object) -> bytes:
    return json.dumps(value, ensure_ascii=False, indent=1).encode()


def _word(flag: bool) -> str:
    return "yes" if flag else "no"


def _portable(value: float | int | None) -> float | int | str | None:
    """JSON knows no infinity, but an unreachable goal is infinitely far."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _number(value: float | int | str | None) -> float | int | None:
    return float(value) if isinstance(value, str) else value
