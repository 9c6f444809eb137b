"""What things are made of: one shared look per material and colour."""

from __future__ import annotations

from functools import cache

from c2nav_engine.world.builtin import pictures, textures
from c2nav_engine.world.builtin.mesh import Look
from c2nav_engine.world.builtin.palette import COLOURS, WOODS, Rgb, mix, shade
from c2nav_engine.world.builtin.textures import Texture
from c2nav_engine.world.scene import Material


def look_of(
    name: str, texture: Texture, *, tile_m: float = 1.0, glow: float = 0.0, thin: bool = False
) -> Look:
    """A look around a finished picture."""
    return Look(Material(name, texture=texture), tile_m, glow, thin)


@cache
def wood(name: str) -> Look:
    """Furniture wood by its name in `WOODS`."""
    return look_of(f"{name} wood", textures.wood(WOODS[name]), tile_m=0.9)


@cache
def fabric(colour: str, *, light: float = 1.0) -> Look:
    """Upholstery in a named colour."""
    return look_of(f"{colour} fabric", textures.fabric(shade(COLOURS[colour], light)), tile_m=0.25)


@cache
def lacquer(colour: str, *, light: float = 1.0) -> Look:
    """Paint, plastic or ceramics in a named colour."""
    return look_of(f"{colour} lacquer", textures.plain(shade(COLOURS[colour], light)))


@cache
def trim() -> Look:
    """White skirting and frames."""
    return Look(Material("trim", texture=textures.plain((232, 231, 226))), thin=True)


@cache
def solid(rgb: Rgb) -> Look:
    """Any colour that needs no word."""
    return look_of("plain", textures.plain(rgb))


@cache
def metal(*, dark: bool = False) -> Look:
    """Brushed steel, or black iron."""
    rgb: Rgb = (58, 58, 62) if dark else (184, 188, 192)
    return look_of("metal", textures.wood(rgb), tile_m=2.0)


@cache
def stone() -> Look:
    """Worktop."""
    return look_of("stone", textures.marble((214, 212, 206)), tile_m=1.5)


@cache
def lamp_glow() -> Look:
    """The lit inside of a lamp or ceiling light."""
    return Look(Material("lamp", texture=textures.plain((255, 248, 226)), unlit=True), 1.0, 3.0)


@cache
def window_view(seed: int) -> Look:
    """The view from a window."""
    material = Material("window view", texture=pictures.outdoors(seed), unlit=True)
    return Look(material, 1.0, 2.2)


@cache
def leaves(light: float = 1.0) -> Look:
    """Foliage; one copy of the texture a leaf."""
    return look_of("leaves", textures.leaf(shade((70, 128, 62), light)))


@cache
def painting(colour: str, seed: int) -> Look:
    """A painted canvas around a named colour."""
    painted = (pictures.landscape, pictures.abstract)[seed % 2](COLOURS[colour], seed)
    return look_of(f"{colour} painting", painted, thin=True)


@cache
def rug(colour: str, seed: int) -> Look:
    """A whole rug in a named colour."""
    rgb = COLOURS[colour]
    accent = mix(shade(rgb, 0.5), (40, 36, 60), 0.35)
    woven = (textures.rug, textures.striped_rug)[seed % 2](rgb, accent)
    return look_of(f"{colour} rug", woven)


@cache
def books(seed: int) -> Look:
    """A row of book spines."""
    return look_of("books", textures.books(seed), thin=True)


@cache
def screen() -> Look:
    """A television that is off."""
    return look_of("screen", pictures.screen(), thin=True)


@cache
def clock_face() -> Look:
    """A clock's dial."""
    return look_of("clock", pictures.clock(), thin=True)


@cache
def mirror() -> Look:
    """A mirror's glass."""
    return look_of("mirror", pictures.mirror(), thin=True)


@cache
def water() -> Look:
    """An aquarium's front."""
    return look_of("aquarium", pictures.aquarium(), glow=0.8)
