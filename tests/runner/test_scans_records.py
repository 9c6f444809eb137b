"""What a run says about its scans: floor, headings, ground truth; what it says when they lack."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from c2nav_engine.episodes.files import write_episodes
from c2nav_engine.episodes.profile import LAVIRA, VLNCE
from c2nav_engine.errors import EpisodeError, SceneError
from c2nav_engine.geometry import Pinhole
from c2nav_engine.runner.opening import OpenSpec
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from tests.helpers.benches import workbench
from tests.helpers.navmesh_bytes import MeshSpec, TileSpec, write_navmesh
from tests.helpers.scans import scans, write_scans

EYES = Pinhole(32, 32, math.radians(90.0))
OPENNAV = "data/OpenNav_R2R-CE_100_bertidx.json.gz"
NEWER = "data/R2R_VLNCE_v1-3_val_unseen.json.gz"


@pytest.fixture(scope="module")
def source(tmp_path_factory) -> Source:
    folder = tmp_path_factory.mktemp("scans")
    return open_source(str(write_scans(folder)), scenes=folder)


@pytest.fixture(scope="module")
def older(shared) -> Source:
    """Open-Nav's hundred with the headings that it carries."""
    return open_source(str(shared / OPENNAV))


@pytest.fixture(scope="module")
def newer(shared) -> Source:
    """The same with the headings of the newer file."""
    return open_source(str(shared / OPENNAV), headings=shared / NEWER)


@pytest.fixture(scope="module")
def headers(source, tmp_path_factory):
    """Headers of opened episodes, by profile and episode id."""
    cache = tmp_path_factory.mktemp("cache")

    def opened(profile, episode_id):
        profile = replace(profile, rgb=EYES, depth=EYES)
        run = workbench(source, profile=profile, cache=cache).open(OpenSpec(episode_id))
        run.close()
        return run.header

    return opened


def test_a_navmesh_beside_the_scan_is_used_and_named(headers):
    header = headers(VLNCE, "1")
    assert header.surface == "navmesh"
    assert "surface_note" not in header.extra


def test_without_one_a_floor_is_built_and_the_record_says_so(headers):
    assert headers(VLNCE, "2").surface == "built"


def test_off_mesh_links_that_were_left_out_are_noted(tmp_path):
    source = open_source(str(write_scans(tmp_path)), scenes=tmp_path)
    scan = scans()[0]
    tile = TileSpec([list(polygon) for polygon in scan.floor], connections=2)
    beside = (tmp_path / scan.scene_id).with_suffix(".navmesh")
    beside.write_bytes(write_navmesh(MeshSpec([tile], tile_size_m=16.0)))
    world = Worlds(source, WorldsConfig(VLNCE, cache=tmp_path)).of(scan.scene_id)
    assert "2 off-mesh connections are ignored" in world.note


def test_another_body_than_habitats_is_noted(headers):
    note = headers(LAVIRA, "1").extra["surface_note"]
    assert "0.88 m" in note
    assert "recompute" in note
    assert "surface_note" not in headers(LAVIRA, "2").extra


@pytest.mark.parametrize("number", range(10))
def test_both_kinds_of_floor_measure_what_is_true(source, number, tmp_path):
    scan, episode = scans()[number], source.file.episodes[number]
    surface = Worlds(source, WorldsConfig(VLNCE, cache=tmp_path)).of(scan.scene_id).surface
    start, goal = surface.snap(episode.start.position_m), surface.snap(scan.goal_m)
    assert start is not None
    assert goal is not None
    assert goal[1] == pytest.approx(scan.goal_m[1], abs=0.2)
    assert surface.geodesic_m(start, goal) == pytest.approx(scan.geodesic_m, rel=0.03)


def test_a_scan_is_turned_upright(source):
    low_m, high_m = source.scene(scans()[0].scene_id).bounds_m
    # A room 8 by 5 m with walls of 2.4 m, its floor slab below 0.
    np.testing.assert_allclose(low_m, (-0.1, -0.1, -0.1), atol=1e-3)
    np.testing.assert_allclose(high_m, (8.1, 2.4, 5.1), atol=1e-3)


def test_scans_keep_their_own_light_and_parts(source):
    scene = source.scene(scans()[0].scene_id)
    assert {part.name for part in scene.parts} == {"chunk000", "chunk001", "chunk002"}
    assert all(material.unlit for material in scene.materials)


def test_all_missing_scans_are_named_at_once(older):
    episodes = older.file.episodes
    missing = older.missing_scenes(episodes)
    assert len(missing) == 10
    blocked = sorted(episode_id for ids in missing.values() for episode_id in ids)
    assert blocked == sorted(episode.episode_id for episode in episodes)
    with pytest.raises(SceneError) as caught:
        older.require_scenes(episodes)
    assert all(scene_id in str(caught.value) for scene_id in missing)
    assert "100 of 100" in str(caught.value)


def test_scans_that_are_there_are_not_missing(source):
    assert source.missing_scenes(source.file.episodes) == {}
    source.require_scenes(source.file.episodes)


def test_each_heading_version_goes_with_its_own_ground_truth(older, newer):
    assert older.file.headings.startswith("v1-2")
    assert newer.file.headings.startswith("v1-3")
    assert older.ground_truth_name == "R2R_VLNCE_v1-2_val_unseen_gt.json.gz"
    assert newer.ground_truth_name == "R2R_VLNCE_v1-3_val_unseen_gt.json.gz"


def test_borrowed_headings_are_recorded_beside_the_files_own(older, newer):
    assert newer.facts()["source_headings"].startswith("v1-2")
    assert newer.facts()["ground_truth"] == "R2R_VLNCE_v1-3_val_unseen_gt.json.gz"
    assert "source_headings" not in older.facts()


def test_the_two_versions_differ_in_every_heading_and_in_no_place(older, newer):
    gaps_rad: list[float] = []
    for old, new in zip(older.file.episodes, newer.file.episodes, strict=True):
        assert old.start.position_m == pytest.approx(new.start.position_m, abs=0.01)
        assert (old.instruction, old.goal_m) == (new.instruction, new.goal_m)
        gap_rad = old.start.yaw_rad - new.start.yaw_rad
        gaps_rad.append(abs(math.remainder(gap_rad, math.tau)))
    assert min(gaps_rad) > 1e-3
    assert math.degrees(float(np.median(gaps_rad))) == pytest.approx(98.0, abs=2.0)


def test_headings_of_other_episodes_are_refused(shared, tmp_path):
    with pytest.raises(EpisodeError):
        open_source(str(write_scans(tmp_path)), headings=shared / "data/furnished_house_8.json.gz")


def test_the_sources_own_ground_truth_is_not_taken_with_borrowed_headings(tmp_path, source):
    """A `_gt` file with the source's own name belongs to the headings that were replaced."""
    mine, theirs = tmp_path / "R2R_v1-2_mine", tmp_path / "other" / "R2R_v1-3_theirs"
    for stem in (mine, theirs):
        write_episodes(stem.with_name(f"{stem.name}.json"), source.file.episodes)
        stem.with_name(f"{stem.name}_gt.json").write_text("{}", encoding="utf-8")

    def truth() -> str:
        headings = theirs.with_name("R2R_v1-3_theirs.json")
        return open_source(f"{mine}.json", headings=headings).ground_truth_name

    assert truth() == "R2R_v1-3_theirs_gt.json"
    theirs.with_name("R2R_v1-3_theirs_gt.json").unlink()
    assert truth() == "reference path"
