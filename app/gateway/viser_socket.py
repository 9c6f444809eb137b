"""viser's websocket, behind our own doors."""

from __future__ import annotations

import asyncio
import contextlib

from fastapi import APIRouter
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

_PROTOCOL = "viser-v"

_SHARE = b"ShareUrlRequest"
"""viser lets any client open a public tunnel; that message never gets through."""


def viser_socket(port: int) -> APIRouter:
    """The websocket at the root, passed on to the viser server on a loopback port."""
    router = APIRouter()

    @router.websocket("/")
    async def socket(page: WebSocket) -> None:
        wanted: list[str] = page.scope.get("subprotocols", [])
        protocol = next((name for name in wanted if name.startswith(_PROTOCOL)), None)
        if protocol is None:
            await page.close(code=1002)
            return
        async with connect(
            f"ws://127.0.0.1:{port}/",
            subprotocols=[Subprotocol(protocol)],
            max_size=None,
            compression=None,
            proxy=None,
        ) as viser:
            await page.accept(subprotocol=protocol)
            await _relay(page, viser)

    return router


async def _relay(page: WebSocket, viser: ClientConnection) -> None:
    ways = [asyncio.create_task(_to_viser(page, viser)), asyncio.create_task(_to_page(page, viser))]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await page.close()


async def _to_viser(page: WebSocket, viser: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed):
        while True:
            frame = await page.receive_bytes()
            if _SHARE not in frame[:4096]:
                await viser.send(frame)


async def _to_page(page: WebSocket, viser: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed, RuntimeError):
        async for frame in viser:
            await (page.send_bytes(frame) if isinstance(frame, bytes) else page.send_text(frame))
