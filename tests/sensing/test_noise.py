"""Sensor noise: absent by default, seeded, unbiased, and of the size that was asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.errors import UsageError
from c2nav_engine.geometry import Pose
from c2nav_engine.sensing.noise import NoiseConfig, NoisySensors, composed, relative

START = Pose((1.0, 0.1, -2.0), 0.7)


def sensors(seed: int = 0, **options: float) -> NoisySensors:
    return NoisySensors(NoiseConfig(**options), np.random.default_rng(seed))


def random_poses(count: int) -> list[Pose]:
    rng = np.random.default_rng(5)
    return [
        Pose((float(x), float(y), float(z)), float(yaw))
        for x, y, z, yaw in zip(*rng.uniform(-3.0, 3.0, (4, count)), strict=True)
    ]


def close(a: Pose, b: Pose) -> bool:
    turn = math.remainder(a.yaw_rad - b.yaw_rad, math.tau)
    return bool(np.allclose(a.position_m, b.position_m, atol=1e-9)) and abs(turn) < 1e-9


def test_composition_undoes_the_relative_motion():
    poses = random_poses(40)
    for before, after in zip(poses[::2], poses[1::2], strict=True):
        assert close(composed(before, relative(before, after)), after)


def test_a_step_ahead_is_measured_as_one():
    after = Pose(START.ahead(0.25), START.yaw_rad)
    motion = relative(START, after)
    assert motion.ahead_m == pytest.approx(0.25)
    assert motion.left_m == pytest.approx(0.0, abs=1e-12)
    left = Pose(START.turned(math.pi / 2.0).ahead(0.25), START.yaw_rad)
    assert relative(START, left).left_m == pytest.approx(0.25)


def test_without_noise_belief_is_the_truth_itself():
    quiet = sensors()
    after = Pose(START.ahead(0.25), START.yaw_rad + 0.1)
    assert quiet.odometry(START, START, after) is after
    depth_m = np.ones((2, 2), np.float32)
    assert quiet.depth(depth_m) is depth_m


def test_the_same_seed_gives_the_same_readings():
    depth_m = np.full((20, 20), 2.0, np.float32)
    options = {"translation": 0.1, "rotation": 0.1, "depth": 0.05, "holes": 0.1}
    after = Pose(START.ahead(0.25), 0.8)
    one, two, other = sensors(3, **options), sensors(3, **options), sensors(4, **options)
    assert one.odometry(START, START, after) == two.odometry(START, START, after)
    assert np.array_equal(one.depth(depth_m), two.depth(depth_m))
    assert one.odometry(START, START, after) != other.odometry(START, START, after)


def test_step_lengths_scatter_as_asked():
    noisy = sensors(translation=0.1)
    after = Pose(START.ahead(0.25), START.yaw_rad)
    lengths_m = [
        math.dist(START.position_m, noisy.odometry(START, START, after).position_m)
        for _ in range(4000)
    ]
    assert np.mean(lengths_m) == pytest.approx(0.25, rel=0.01)
    assert np.std(lengths_m) == pytest.approx(0.025, rel=0.05)


def test_turns_scatter_and_standing_still_does_not():
    noisy = sensors(rotation=0.05, drift_rad_per_m=0.02)
    turned = START.turned(math.radians(15.0))
    yaws = [noisy.odometry(START, START, turned).yaw_rad for _ in range(4000)]
    assert np.std(yaws) == pytest.approx(0.05 * math.radians(15.0), rel=0.05)
    assert close(noisy.odometry(START, START, START), START)


def test_drift_grows_with_the_root_of_the_way():
    def drift_after(steps: int) -> float:
        ends: list[float] = []
        for seed in range(400):
            noisy, believed, true = sensors(seed, drift_rad_per_m=0.05), START, START
            for _ in range(steps):
                moved = Pose(true.ahead(0.25), true.yaw_rad)
                believed, true = noisy.odometry(believed, true, moved), moved
            ends.append(believed.yaw_rad - START.yaw_rad)
        return float(np.std(ends))

    assert drift_after(4) == pytest.approx(0.05, rel=0.1)
    assert drift_after(16) == pytest.approx(0.10, rel=0.1)


def test_depth_scatters_and_has_holes_as_asked():
    sensed = sensors(depth=0.02, holes=0.25).depth(np.full((200, 200), 4.0, np.float32))
    assert sensed.dtype == np.float32
    returned = sensed[sensed > 0.0]
    assert 1.0 - returned.size / sensed.size == pytest.approx(0.25, abs=0.02)
    assert returned.mean() == pytest.approx(4.0, rel=0.01)
    assert returned.std() == pytest.approx(0.08, rel=0.05)


def test_holes_stay_holes():
    assert not sensors(depth=0.5).depth(np.zeros((10, 10), np.float32)).any()


@pytest.mark.parametrize(
    "options",
    [
        {"translation": -0.1},
        {"holes": 1.5},
        {"depth": -1.0},
        {"rotation": math.inf},
        {"drift_rad_per_m": math.nan},
        {"depth": math.nan},
        {"holes": math.nan},
    ],
)
def test_impossible_noise_is_refused(options):
    with pytest.raises(UsageError, match="expected deviations"):
        NoiseConfig(**options)
