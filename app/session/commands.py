"""Everything a person can do, as values: the same from buttons, keys, palette and HTTP.

A command that changes what was answered must carry the `id` of the state it was given in, so
that a second tab or a late click cannot answer a question that its sender did not see.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, TypeAdapter, field_validator

from c2nav_engine.contract.outcome import Key

Text = Annotated[str, Field(max_length=4096)]
"""Names and keys of a state. The bound also refuses what is no Unicode."""


class Command(BaseModel):
    """Base of all commands.

    Attributes:
        id: Id of the state that the sender saw; None where it does not matter.
        tab: Which open page sent it ("" for the server's own controls).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: Text | None = None
    tab: str = Field(default="", max_length=40)


class Answering(Command):
    """Base of the commands that answer a question: their `id` is compulsory over HTTP."""


# ---------------------------------------------------------------- moving about


class Step(Command):
    """Commit what is proposed at the newest decision, or go to the next recorded one."""

    type: Literal["step"] = "step"


class Move(Command):
    """Go forward or back by decisions or by low-level steps."""

    type: Literal["move"] = "move"
    by: Literal["decision", "step"]
    count: int = Field(ge=-1000, le=1000)


class Go(Command):
    """Go to a decision or a step of a branch; −1 leaves a number open."""

    type: Literal["go"] = "go"
    branch: Text = ""
    decision: int = -1
    step: int = -1


class Play(Command):
    """Go on by itself."""

    type: Literal["play"] = "play"


class Pause(Command):
    """Stop going on by itself."""

    type: Literal["pause"] = "pause"


class RunTo(Command):
    """Go on as fast as possible to the next decision of a lane, or to the end."""

    type: Literal["run_to"] = "run_to"
    until: Literal["seeing", "transition", "arriving", "end"]


class Open(Command):
    """Open an episode or trace of the source; empty fields keep what is chosen."""

    type: Literal["open"] = "open"
    entry: Text = ""
    variant: Text = ""
    ranker: Text = ""


class Jump(Command):
    """Go to a decision that is worth a look."""

    type: Literal["jump"] = "jump"
    to: Literal["first_suspect", "worst_suspect", "next_disagreement", "previous_disagreement"]


class Seek(Command):
    """Choose which disagreement `next_disagreement` looks for."""

    type: Literal["seek"] = "seek"
    kind: Literal["any", "orders", "person", "reasked", "best"]


# ---------------------------------------------------------------- answering


class Press(Answering):
    """Rank one more alternative, by key or by its letter's position (0 is A)."""

    type: Literal["press"] = "press"
    key: Text = ""
    position: int = -1


class Arrange(Answering):
    """Rank by dragging: tiers of keys, best first."""

    type: Literal["arrange"] = "arrange"
    tiers: tuple[tuple[Text, ...], ...]

    @field_validator("tiers")
    @classmethod
    def _each_once(cls, tiers: tuple[tuple[Key, ...], ...]) -> tuple[tuple[Key, ...], ...]:
        keys = [key for tier in tiers for key in tier]
        if len(set(keys)) < len(keys):
            message = f"expected each alternative once, came {keys}"
            raise ValueError(message)
        return tiers


class Tie(Answering):
    """Let the next alternative share the last rank."""

    type: Literal["tie"] = "tie"


class NoneOfThese(Answering):
    """Reject every alternative."""

    type: Literal["none"] = "none"


class TakeBack(Answering):
    """Undo the last press."""

    type: Literal["take_back"] = "take_back"


class Clear(Answering):
    """Drop the person's ranking and any fork that waits for a yes."""

    type: Literal["clear"] = "clear"


class Commit(Answering):
    """Commit the person's ranking, or the proposal where the person said nothing."""

    type: Literal["commit"] = "commit"
    why: str = Field(default="", max_length=2000)


class Why(Command):
    """Say why, beside the ranking that is being made; it is kept with the answer."""

    type: Literal["why"] = "why"
    text: str = Field(max_length=2000)


class Cancel(Command):
    """Stop waiting for the model; a person may answer instead."""

    type: Literal["cancel"] = "cancel"


class AskAgain(Command):
    """Put the pending question to the ranker once more."""

    type: Literal["ask_again"] = "ask_again"


class Consent(Command):
    """Allow or refuse that pictures leave this machine for a named host."""

    type: Literal["consent"] = "consent"
    allow: bool


# ---------------------------------------------------------------- looking


class Hover(Command):
    """Light an alternative in strip and map; "" for none."""

    type: Literal["hover"] = "hover"
    key: Text = ""


class Camera(Command):
    """How the map is looked at."""

    type: Literal["camera"] = "camera"
    mode: Literal["free", "follow", "ego", "top"]


class Layer(Command):
    """Show or hide something in the map."""

    type: Literal["layer"] = "layer"
    name: str = Field(max_length=40)
    on: bool


class Place(Command):
    """Ask where a place was seen: a point, a ray of the map, a picture's pixel, or the goal."""

    type: Literal["place"] = "place"
    point_m: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None
    ray_from_m: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None
    ray_along: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None
    goal: bool = False
    sha256: str = Field(default="", max_length=64)
    column: FiniteFloat = 0.0
    row: FiniteFloat = 0.0


class ForgetPlace(Command):
    """Take the asked place away."""

    type: Literal["forget_place"] = "forget_place"


# ---------------------------------------------------------------- judging


class Verdict(Command):
    """A person's verdict on the decision in view; the same again takes it back."""

    type: Literal["verdict"] = "verdict"
    value: Literal["agree", "acceptable", "wrong", "cannot tell"]


class Tag(Command):
    """Add a failure tag to the decision in view, or take it off."""

    type: Literal["tag"] = "tag"
    value: str = Field(min_length=1, max_length=60)


class Better(Command):
    """Name the better alternative, by key or by its letter's position (0 is A), or take it back."""

    type: Literal["better"] = "better"
    key: Text = ""
    position: int = -1


class LegEnd(Command):
    """Say at which low-level step a leg ends, both from 0."""

    type: Literal["leg_end"] = "leg_end"
    leg: int = Field(ge=0, le=100)
    step: int = Field(ge=0)


class Cover(Command):
    """Cover the answers that are not yet made one's own, or show them all again."""

    type: Literal["cover"] = "cover"
    on: bool


class Reveal(Command):
    """Show the covered answer of the decision in view; it has been seen from then on."""

    type: Literal["reveal"] = "reveal"


class Tags(Command):
    """Replace the list of tags to choose from."""

    type: Literal["tags"] = "tags"
    names: tuple[Annotated[str, Field(max_length=60)], ...] = Field(max_length=100)


class Flag(Command):
    """Mark the decision in view for later, or take the mark off."""

    type: Literal["flag"] = "flag"


class Remark(Command):
    """A note on the decision in view; empty takes it away."""

    type: Literal["remark"] = "remark"
    text: str = Field(max_length=4000)


class Undo(Command):
    """Take the last judgement back."""

    type: Literal["undo"] = "undo"


class Redo(Command):
    """Judge again what was taken back."""

    type: Literal["redo"] = "redo"


# ---------------------------------------------------------------- turning points


class MeasureTurning(Command):
    """Measure regret and the last recoverable decision of the failed branch in view."""

    type: Literal["measure_turning"] = "measure_turning"


class TryAnswers(Command):
    """Try other answers at its worst decisions, or take that up where it was left."""

    type: Literal["try_answers"] = "try_answers"


class CancelTrying(Command):
    """Stop trying other answers; what was tried is kept."""

    type: Literal["cancel_trying"] = "cancel_trying"


class OpenFlip(Command):
    """Go to the branch of an answer that was tried."""

    type: Literal["open_flip"] = "open_flip"
    decision: int = Field(ge=0)
    answer: str = Field(max_length=60)


class Name(Command):
    """Who sits at the page, for overrides and judgements."""

    type: Literal["name"] = "name"
    who: str = Field(max_length=60)


AnyCommand = Annotated[
    Step
    | Move
    | Go
    | Play
    | Pause
    | RunTo
    | Open
    | Jump
    | Seek
    | Press
    | Arrange
    | Tie
    | NoneOfThese
    | TakeBack
    | Clear
    | Commit
    | Why
    | Cancel
    | AskAgain
    | Consent
    | Hover
    | Camera
    | Layer
    | Place
    | ForgetPlace
    | Verdict
    | Tag
    | Better
    | LegEnd
    | Cover
    | Reveal
    | Tags
    | Flag
    | Remark
    | Undo
    | Redo
    | MeasureTurning
    | TryAnswers
    | CancelTrying
    | OpenFlip
    | Name,
    Field(discriminator="type"),
]

COMMAND: TypeAdapter[AnyCommand] = TypeAdapter(AnyCommand)
"""Reads a command from JSON."""
