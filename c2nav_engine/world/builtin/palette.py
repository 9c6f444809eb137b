"""Named colours of the built-in houses: wider than the basic colour words, all tellable apart."""

from __future__ import annotations

Rgb = tuple[int, int, int]
"""sRGB, 0–255."""

COLOURS: dict[str, Rgb] = {
    "red": (186, 44, 42),
    "crimson": (150, 22, 48),
    "maroon": (104, 30, 36),
    "coral": (236, 118, 92),
    "pink": (232, 160, 178),
    "orange": (224, 122, 42),
    "ochre": (198, 146, 54),
    "mustard": (206, 168, 40),
    "yellow": (238, 206, 66),
    "olive": (116, 116, 54),
    "green": (62, 128, 66),
    "sage": (152, 172, 140),
    "mint": (158, 212, 184),
    "teal": (24, 118, 122),
    "turquoise": (62, 182, 186),
    "blue": (46, 92, 168),
    "navy": (32, 44, 88),
    "lavender": (172, 156, 212),
    "purple": (110, 62, 134),
    "plum": (112, 46, 92),
    "brown": (112, 76, 50),
    "beige": (214, 198, 170),
    "cream": (240, 232, 212),
    "white": (242, 242, 238),
    "grey": (146, 148, 150),
    "charcoal": (62, 64, 70),
    "black": (34, 34, 38),
}
"""Every colour word that an instruction may use."""

WOODS: dict[str, Rgb] = {
    "oak": (190, 148, 98),
    "pine": (214, 176, 122),
    "walnut": (104, 70, 48),
    "cherry": (142, 78, 52),
    "birch": (222, 198, 158),
    "ebony": (62, 50, 44),
}

ACCENTS = (
    "red",
    "maroon",
    "coral",
    "pink",
    "orange",
    "ochre",
    "mustard",
    "yellow",
    "olive",
    "green",
    "mint",
    "teal",
    "turquoise",
    "blue",
    "navy",
    "lavender",
    "purple",
    "plum",
    "crimson",
)
"""Colours for things worth mentioning."""

WALLS: dict[str, Rgb] = {
    "chalk": (236, 232, 224),
    "linen": (228, 218, 200),
    "dove": (206, 210, 212),
    "sage": (196, 208, 188),
    "duck egg": (190, 212, 214),
    "blush": (230, 206, 200),
    "butter": (238, 222, 178),
    "lilac": (214, 206, 224),
    "terracotta": (204, 150, 124),
    "denim": (132, 154, 182),
    "moss": (150, 164, 132),
    "sand": (220, 200, 168),
    "slate": (140, 152, 160),
}
"""Muted wall paints, so that accents stand out before them."""


def shade(rgb: Rgb, factor: float) -> Rgb:
    """The colour made darker (under 1) or lighter (over 1), clipped."""
    red, green, blue = (max(0, min(255, round(channel * factor))) for channel in rgb)
    return (red, green, blue)


def mix(first: Rgb, second: Rgb, share: float) -> Rgb:
    """`share` of the second colour in the first."""
    red, green, blue = (
        round(a * (1.0 - share) + b * share) for a, b in zip(first, second, strict=True)
    )
    return (red, green, blue)
