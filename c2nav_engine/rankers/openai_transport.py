"""One JSON request over the `openai` client, with every failure named.

The client's own retries are off: the wrapper owns them, and an exhausted quota arrives as a 429
that the client would retry for ever. Three things stop a run: a rejected key (401, 403), an
exhausted quota and a refused connection. The key goes into the Authorization header and nowhere
else; whatever the server says is scrubbed of it before it is kept.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import cast

import openai

from c2nav_engine.contract.outcome import Refused, TransportFailure
from c2nav_engine.contract.prompt import Reply
from c2nav_engine.errors import RankerStopped
from c2nav_engine.rankers.openai_settings import ServerSettings

Json = Mapping[str, object]
_LONGEST_MESSAGE = 200
_RETRIED_STATUS = frozenset({408, 409, 425, 429, 500, 502, 503, 504, 529})
_FILTERED = frozenset({"content_filter", "content_policy_violation", "moderation_blocked"})


class Transport:
    """Posts JSON bodies to one server.

    Args:
        settings: Where and with which key.
    """

    def __init__(self, settings: ServerSettings) -> None:
        self._settings = settings
        self._key = settings.key()
        self._client = openai.OpenAI(
            base_url=settings.base_url,
            api_key=self._key,
            timeout=settings.timeout_s,
            max_retries=0,
        )

    def post(self, path: str, body: Json) -> Json | Reply:
        """The server's JSON object, or the reply that stands for its failure.

        Raises:
            RankerStopped: No further query makes sense.
        """
        try:
            answer = self._client.post(path, cast_to=object, body=dict(body))
        except openai.OpenAIError as error:
            return self._failure(error)
        except ValueError:
            answer = None
        if not isinstance(answer, Mapping):
            return Reply(outcome=TransportFailure("the server's answer is no JSON object"))
        return self._without_key(cast("Json", answer))

    def close(self) -> None:
        """Close the connections."""
        self._client.close()

    def _failure(self, error: openai.OpenAIError) -> Reply:
        if isinstance(error, openai.APITimeoutError):
            reason = f"no answer within {self._settings.timeout_s:g} s"
            return Reply(outcome=TransportFailure(reason))
        if isinstance(error, openai.APIStatusError):
            return self._status(error)
        if any(isinstance(cause, ConnectionRefusedError) for cause in _causes(error)):
            message = f"expected a server at {self._settings.base_url}, the connection was refused"
            raise RankerStopped(f"{message}. Start it, or correct base_url") from None
        return Reply(outcome=TransportFailure(f"the connection broke: {self._plain(error)}"))

    def _status(self, error: openai.APIStatusError) -> Reply:
        status, code = error.status_code, error.code or ""
        if status in {401, 403}:
            key = self._settings.key_env or "no key_env given"
            message = f"{self._settings.base_url} rejected the key (HTTP {status}; key: {key})"
            raise RankerStopped(f"{message}. Check the variable's value and its rights") from None
        if "insufficient_quota" in {code, error.type}:
            message = f"the quota of {self._settings.model} is used up (HTTP {status})"
            raise RankerStopped(f"{message}. Raise it, then resume the run") from None
        if code in _FILTERED:
            return Reply(outcome=Refused(), text=self._plain(error))
        failure = TransportFailure(f"HTTP {status}: {self._plain(error)}")
        if status not in _RETRIED_STATUS and status < 500:
            return Reply(outcome=failure, retry_after_s=None)
        return Reply(outcome=failure, retry_after_s=_retry_after_s(error))

    def _plain(self, error: openai.OpenAIError) -> str:
        return self._scrubbed(" ".join(str(error).split()))[:_LONGEST_MESSAGE]

    def _without_key(self, answer: Json) -> Json:
        """The answer as it came, but for a server that repeats the key."""
        text = json.dumps(answer)
        scrubbed = self._scrubbed(text)
        return answer if scrubbed == text else json.loads(scrubbed)

    def _scrubbed(self, text: str) -> str:
        # Without a key a placeholder is sent, which is a word like any other.
        return text.replace(self._key, "[key]") if self._settings.key_env else text


def _retry_after_s(error: openai.APIStatusError) -> float:
    """The server's wish in seconds; 0 when it states none that can be read."""
    for header, scale in (("retry-after-ms", 1e-3), ("retry-after", 1.0)):
        try:
            return max(0.0, float(error.response.headers.get(header, "")) * scale)
        except ValueError:
            continue
    return 0.0


def _causes(error: BaseException) -> Iterator[BaseException]:
    seen: BaseException | None = error
    while seen is not None:
        yield seen
        seen = seen.__cause__ or seen.__context__
