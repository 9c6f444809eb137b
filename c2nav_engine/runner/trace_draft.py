"""The messages of one exchange while they are gathered, and where its pictures are stored."""

from __future__ import annotations

from google.protobuf.message import Message

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import InternalError
from c2nav_engine.traces.pb.common_pb2 import Picture as PictureMessage
from c2nav_engine.traces.pb.control_pb2 import Control
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.evaluation_pb2 import Evaluation
from c2nav_engine.traces.pb.route_pb2 import Sketch
from c2nav_engine.traces.topics import DEPTH_TOPIC
from c2nav_engine.traces.viewer_messages import camera_frame, image_message
from c2nav_engine.traces.writer import Outgoing

ANY_PICTURE = "/picture"

Places = dict[str, tuple[str, int]]
"""Digest → topic and log time of every picture that the trace holds: each is stored once."""


class Draft:
    """One exchange's messages, with the table of the pictures they name.

    Args:
        places: What the trace holds already; grows as this exchange stores more.
        time_ns: Log time of the exchange.
    """

    def __init__(self, places: Places, time_ns: int) -> None:
        self._places = places
        self._time_ns = time_ns
        self._table: dict[str, PictureMessage] = {}
        self.messages: list[Outgoing] = []

    def add(self, topic: str, message: Message) -> None:
        """Add a message, with the table of the pictures named since the last one."""
        if self._table:
            if not isinstance(message, Control | Decision | Sketch | Evaluation):
                text = f"expected no picture on {topic}, came {list(self._table)}"
                raise InternalError(text)
            message.pictures.extend(self._table.values())
            self._table = {}
        self.messages.append(Outgoing(topic, message, self._time_ns))

    def keep(self, picture: Picture | None) -> str:
        """Name a picture, and store it on `/picture` when no other topic took it."""
        if picture is not None:
            self.store(picture, ANY_PICTURE)
        return self.name(picture)

    def name(self, picture: Picture | None) -> str:
        """Name a picture, wherever it is stored, or nowhere; "" for None."""
        if picture is None:
            return ""
        topic, time_ns = self._places.get(picture.sha256, ("", 0))
        self._table[picture.sha256] = PictureMessage(
            sha256=picture.sha256,
            width_px=picture.width_px,
            height_px=picture.height_px,
            topic=topic,
            log_time_ns=time_ns,
        )
        return picture.sha256

    def store(self, picture: Picture, topic: str, *, kind: str = "jpeg") -> bool:
        """Store a picture's bytes unless the trace holds them or they are not here."""
        if not picture.jpeg or picture.sha256 in self._places:
            return False
        self.show(picture, topic, kind=kind)
        self._places[picture.sha256] = (topic, self._time_ns)
        return True

    def show(self, picture: Picture, topic: str, *, kind: str = "jpeg") -> None:
        """Publish a picture for viewers."""
        key = topic.rpartition("/")[2]
        frame = camera_frame(key if key in ("left", "right") else "front")
        message = image_message(picture.jpeg, frame=frame, kind=kind, time_ns=self._time_ns)
        self.messages.append(Outgoing(topic, message, self._time_ns))

    def keep_depth(self, png: bytes) -> str:
        """Store and name a depth picture; its size is in the PNG."""
        if not png:
            return ""
        depth = Picture.of(png, width_px=0, height_px=0)
        self.store(depth, DEPTH_TOPIC, kind="png")
        return self.name(depth)
