"""Figures through the gateway: what the Export dialog shows and saves."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.gateway.figures import figures
from app.session import commands as c
from app.session.worker import Session
from c2nav_engine.world.scene import Material, Piece, scene_of
from tests.helpers import stage
from tests.helpers.meshes import slab, surface_of
from tests.helpers.watched import Watched


def client_of(session: Session) -> TestClient:
    app = FastAPI()
    app.include_router(figures(session))
    return TestClient(app)


@pytest.fixture(scope="module")
def recorded() -> Iterator[TestClient]:
    session = Session(stage.opened_recording(cycles=6))
    yield client_of(session)
    session.close()


@pytest.mark.parametrize("kind", ["strip", "map", "curve"])
def test_every_kind_is_drawn_as_vectors(recorded: TestClient, kind: str):
    drawn = recorded.get("/api/figure.svg", params={"kind": kind, "decisions": "0, 3"})
    assert drawn.headers["content-type"] == "image/svg+xml"
    assert drawn.text.startswith("<?xml")
    assert "<text" in drawn.text


def test_the_recipe_is_of_the_very_bytes_that_are_saved(recorded: TestClient):
    asked = {"kind": "curve", "decisions": "2", "width": "3.5in"}
    for file in ("pdf", "svg"):
        figure = recorded.get(f"/api/figure.{file}", params=asked)
        recipe = recorded.get("/api/figure.json", params=asked | {"recipe_of": file}).json()
        assert recipe["figure_sha256"] == hashlib.sha256(figure.content).hexdigest()
        assert recipe["figure"] == f"curve.{file}"
        assert recipe["traces"] == [{"file": "play.mcap", "sha256": "ab" * 32}]
        assert recipe["decisions"] == [2]


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"decisions": "3;4"}, "whole numbers"),
        ({"decisions": "999"}, "expected decisions from 0"),
        ({"decisions": ""}, "came none"),
        ({"decisions": "0", "width": "wide"}, "expected a width"),
        ({"kind": "compare", "decisions": "0"}, "expected a fork in view"),
    ],
)
def test_what_does_not_fit_is_said(recorded: TestClient, asked: dict[str, str], said: str):
    answer = recorded.get("/api/figure.svg", params=asked)
    assert answer.status_code == 422
    assert said in answer.json()["detail"]


def test_a_live_branch_has_figures_but_no_recipe_yet():
    session = Session(stage.opened_live(cycles=3))
    client = client_of(session)
    assert client.get("/api/figure.pdf", params={"kind": "curve"}).content.startswith(b"%PDF")
    answer = client.get("/api/figure.json", params={"kind": "curve"})
    assert answer.status_code == 422
    assert "finished recording" in answer.json()["detail"]
    session.close()


def test_a_fork_is_compared_with_the_branch_it_left():
    watched = Watched(Session(stage.opened_recording(cycles=6)))
    watched.do(c.Go(decision=3))
    watched.do(c.Arrange(tiers=(("left",), ("front",))))
    watched.do(c.Commit())
    watched.do(c.Commit())
    watched.until(lambda s: s.parent is not None)
    drawn = client_of(watched.session).get("/api/figure.svg", params={"kind": "compare"})
    assert drawn.status_code == 200
    assert ">A<" in drawn.text
    assert ">B<" in drawn.text
    watched.session.close()


def test_a_map_has_its_floor_once_the_scene_is_there():
    opened = stage.opened_recording(cycles=3)
    floor = slab(-9.0, -6.0, 9.0, 6.0)
    vertices_m, triangles = floor.mesh()
    piece = Piece(
        "floor", Material("grey"), vertices_m.astype(np.float32), triangles.astype(np.int32)
    )
    scene = scene_of("slab", [piece])
    surface = surface_of([floor])
    plain = opened.open(opened.first)
    whole = replace(
        opened, open=lambda _: replace(plain, scene=lambda: scene, surface=lambda: surface)
    )
    watched = Watched(Session(whole))
    watched.until(lambda s: s.scene_serial > 0)
    client = client_of(watched.session)
    asked = {"kind": "map", "decisions": ""}
    recipe = client.get("/api/figure.json", params=asked).json()
    assert len(recipe["floor"]) == 1
    watched.session.close()
