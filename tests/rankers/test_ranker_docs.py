"""The guide names every ranker, and how to serve every preset."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import urlsplit

import pytest

from c2nav_engine.experiments.rankers import RANKERS
from c2nav_engine.rankers.capabilities import PRESETS

GUIDE = (Path(__file__).resolve().parents[2] / "docs" / "rankers.md").read_text(encoding="utf-8")
ROWS = [line for line in GUIDE.splitlines() if line.startswith("|")]


@pytest.mark.parametrize("name", RANKERS)
def test_every_ranker_is_in_the_guide(name: str):
    assert any(f"`{name}`" in row for row in ROWS)


@pytest.mark.parametrize("name", [name for name in PRESETS if not PRESETS[name].key_env])
def test_every_served_preset_has_its_commands(name: str):
    preset = PRESETS[name]
    port = urlsplit(preset.base_url).port
    commands = [row for row in ROWS if row.startswith(f"| `{name}` |")]
    for server in ("vllm serve", "sglang.launch_server"):
        (command,) = [row for row in commands if server in row]
        assert f"{preset.model} " in command
        assert f"--host 127.0.0.1 --port {port}" in command


def test_the_hosted_preset_has_its_key_and_its_snapshot():
    preset = PRESETS["gpt-5.5"]
    assert preset.model in GUIDE
    assert f"export {preset.key_env}=" in GUIDE
