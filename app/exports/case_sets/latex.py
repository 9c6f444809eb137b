"""`appendix.tex`: one figure and one caption a case, ready to compile or to be cut out."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

_SPECIAL: Mapping[str, str] = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "–": "--",
    "—": "---",
    "“": "``",
    "”": "''",
    "‘": "`",
    "’": "'",
    "…": r"\ldots{}",
    "·": r"\textperiodcentered{}",
    "²": r"\textsuperscript{2}",
    "±": r"$\pm$",
    "×": r"$\times$",
    "≥": r"$\geq$",
    "≤": r"$\leq$",
    "→": r"$\rightarrow$",
    "∞": r"$\infty$",
    "\n": " ",
}

_HEAD = r"""% One figure a case. It compiles as it is (pdflatex appendix.tex); for a paper, copy
% what stands between \begin{document} and \end{document}. Only graphicx is needed.
\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage{graphicx}
\begin{document}
"""
_FIGURE = r"""
\begin{figure}[htbp]
  \centering
  \includegraphics[width=\linewidth]{%s}
  \caption{%s}
  \label{fig:%s}
\end{figure}
"""
_ALONE = 3
"""Figures after which the page is cleared: LaTeX holds at most 18 that wait for a place [C]."""


@dataclass(frozen=True, slots=True)
class Plate:
    """One figure of the appendix.

    Attributes:
        file: The figure, below the folder.
        caption: In plain words.
        label: What it can be referred to by.
    """

    file: str
    caption: str
    label: str


def appendix(title: str, note: str, plates: Sequence[Plate]) -> str:
    """The whole document."""
    parts = [_HEAD, rf"\section*{{{escaped(title)}}}", "\n", escaped(note), "\n"]
    for place, plate in enumerate(plates, start=1):
        parts.append(_FIGURE % (plate.file, escaped(plate.caption), plate.label))
        if place % _ALONE == 0:
            parts.append("\\clearpage\n")
    return "".join([*parts, "\n\\end{document}\n"])


def escaped(text: str) -> str:
    """Plain words as LaTeX: special signs by name, accents kept, other signs left out."""
    return "".join(_SPECIAL.get(sign) or _known(sign) for sign in text)


def _known(sign: str) -> str:
    """Letters of Western languages pass; what the T1 fonts lack would stop the compiler."""
    if sign.isascii():
        return sign if sign.isprintable() else " "
    return sign if sign.isalpha() and unicodedata.name(sign, "").startswith("LATIN") else ""
