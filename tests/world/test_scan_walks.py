"""Ground-truth walks, replayed through our kinematics: headings, steps, turns, slides.

Without the scans, a bare floor stands in for them: where Habitat's walk met no wall, ours must be
the same. Sliding is held against rooms whose answer is a projection.
"""

from __future__ import annotations

import gzip
import json
import math
from pathlib import Path

import numpy as np
import pytest

from c2nav_engine.episodes.files import read_episodes
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.geometry import Point, Pose
from c2nav_engine.world.kinematics import Body
from c2nav_engine.world.navmesh import NavMesh, read_navmesh
from tests.helpers.navmesh_bytes import MeshSpec, TileSpec, rectangle, write_navmesh

STOP, FORWARD, LEFT, RIGHT = range(4)
CLOSE_M = 0.05
VERSIONS = {
    "v1-2": ("OpenNav_R2R-CE_100_bertidx.json.gz", "R2R_VLNCE_v1-2_val_unseen_gt.json.gz"),
    "v1-3": ("R2R_VLNCE_v1-3_val_unseen.json.gz", "R2R_VLNCE_v1-3_val_unseen_gt.json.gz"),
}


def floor(folder: Path, half_m: float) -> NavMesh:
    """A square without obstacles around the origin."""
    path = folder / f"floor{half_m}.navmesh"
    size = 2 * half_m
    tiles = [
        TileSpec([rectangle((x, z), (x + half_m, z + half_m))], cell=(round(x / half_m), cell_z))
        for x in (-half_m, 0.0)
        for cell_z, z in ((-1, -half_m), (0, 0.0))
    ]
    path.write_bytes(write_navmesh(MeshSpec(tiles, tile_size_m=half_m)))
    mesh = read_navmesh(path)
    assert len(mesh.islands) == 1
    assert mesh.islands[0].area_m2 == pytest.approx(size * size)
    return mesh


def walked(body: Body, start: Pose, actions: list[int]) -> list[Pose]:
    """The start and the pose after every forward step."""
    poses = [start]
    pose = start
    for action in actions:
        if action == FORWARD:
            pose = body.forward(pose).pose
            poses.append(pose)
        elif action != STOP:
            pose = body.turn(pose, left=action == LEFT)
    return poses


def in_plan(points: list[Point]) -> np.ndarray:
    return np.array(points)[:, (0, 2)]


@pytest.mark.parametrize("version", VERSIONS)
def test_a_walk_without_walls_is_habitats(shared, tmp_path, version):
    episode_file, truth_file = (shared / "data" / name for name in VERSIONS[version])
    truth = json.loads(gzip.decompress(truth_file.read_bytes()))
    # Every walk is moved to the middle of one floor; stairs are compared in plan.
    body = Body(floor(tmp_path, 64.0), VLNCE)
    replayed = 0
    for episode in read_episodes(episode_file).episodes[:400]:
        record = truth[episode.episode_id]
        places = in_plan([tuple(place) for place in record["locations"]])
        moves_m = np.linalg.norm(np.diff(places, axis=0), axis=1)
        if not (np.abs(moves_m - VLNCE.step_m) < 1e-4).all():
            continue
        start = Pose((0.0, 0.0, 0.0), episode.start.yaw_rad)
        poses = walked(body, start, record["actions"])
        gaps_m = np.linalg.norm(
            in_plan([pose.position_m for pose in poses]) - (places - places[0]), axis=1
        )
        assert len(poses) == len(places)
        assert gaps_m.max() < CLOSE_M, episode.episode_id
        replayed += 1
    # Half of the walks and more touch no wall: enough to hold the conventions.
    assert replayed > 70


@pytest.mark.parametrize("version", VERSIONS)
def test_each_step_leaves_along_its_own_heading(shared, tmp_path, version):
    """Walks that did meet walls agree step by step wherever Habitat moved freely."""
    episode_file, truth_file = (shared / "data" / name for name in VERSIONS[version])
    truth = json.loads(gzip.decompress(truth_file.read_bytes()))
    body = Body(floor(tmp_path, 64.0), VLNCE)
    origin = (0.0, 0.0, 0.0)
    steps = agreed = 0
    for episode in read_episodes(episode_file).episodes[:200]:
        record = truth[episode.episode_id]
        places = in_plan([tuple(place) for place in record["locations"]])
        pose, index = Pose(origin, episode.start.yaw_rad), 0
        for action in record["actions"]:
            if action == FORWARD:
                moved = places[index + 1] - places[index]
                index += 1
                if abs(np.linalg.norm(moved) - VLNCE.step_m) < 1e-4:
                    ours = in_plan([body.forward(pose).pose.position_m])[0]
                    steps += 1
                    agreed += bool(np.linalg.norm(ours - moved) < 1e-3)
            elif action != STOP:
                pose = body.turn(pose, left=action == LEFT)
    assert steps > 2000
    # A long slide can end exactly a step away, in another direction: those few are not ours.
    assert agreed / steps > 0.99


@pytest.mark.parametrize(("version", "low", "high"), [("v1-2", 0.3, 0.7), ("v1-3", 0.7, 0.95)])
def test_an_opening_turn_fits_newer_headings_better(shared, version, low, high):
    """The words "turn left" agree with the walk by chance under v1-2 and mostly under v1-3."""
    opennav = {e.episode_id for e in read_episodes(shared / "data" / VERSIONS["v1-2"][0]).episodes}
    episode_file, truth_file = (shared / "data" / name for name in VERSIONS[version])
    truth = json.loads(gzip.decompress(truth_file.read_bytes()))
    said = {"left": LEFT, "right": RIGHT}
    hits: list[bool] = []
    for episode in read_episodes(episode_file).episodes:
        words = episode.instruction.lower().replace(",", " ").replace(".", " ").split()
        if words[0] != "turn" or words[1] not in said:
            continue
        if version == "v1-2" and episode.episode_id not in opennav:
            continue
        first = truth[episode.episode_id]["actions"][0]
        if first in said.values():
            hits.append(first == said[words[1]])
    assert low < np.mean(hits) < high, len(hits)


def clamped(point: Point, half_m: float) -> Point:
    """Where a slide along axis-aligned walls ends: the wish, projected onto the room."""
    x, y, z = point
    return (min(max(x, -half_m), half_m), y, min(max(z, -half_m), half_m))


@pytest.mark.parametrize("seed", range(5))
def test_a_walk_along_walls_slides_as_projected(tmp_path, seed):
    """Hundreds of random actions in a small room: drift would add up to more than 5 cm."""
    half_m = 1.5
    body = Body(floor(tmp_path, half_m), VLNCE)
    random = np.random.default_rng(seed)
    pose = expected = Pose((0.0, 0.0, 0.0), float(random.uniform(-math.pi, math.pi)))
    slid = 0
    for action in random.choice([FORWARD, FORWARD, FORWARD, LEFT, RIGHT], 300).tolist():
        if action == FORWARD:
            step = body.forward(pose)
            pose = step.pose
            slid += step.collided
            expected = Pose(clamped(expected.ahead(VLNCE.step_m), half_m), expected.yaw_rad)
        else:
            pose = body.turn(pose, left=action == LEFT)
            expected = body.turn(expected, left=action == LEFT)
        assert math.dist(pose.position_m, expected.position_m) < CLOSE_M
    assert slid > 20
