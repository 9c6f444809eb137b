"""`appendix.tex`: one figure and one caption a case, ready to compile or to be cut out."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

_GREEK = (
    *("alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa"),
    *("lambda", "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi"),
    *("omega", "Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Phi", "Psi", "Omega"),
)


def _greek(name: str) -> str:
    """The letter of that name; Unicode writes lambda without its b."""
    size = "CAPITAL" if name[0].isupper() else "SMALL"
    return unicodedata.lookup(f"GREEK {size} LETTER {name.upper().replace('LAMBDA', 'LAMDA')}")


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
    "✕": r"$\times$",
    "÷": r"$\div$",
    "−": "$-$",
    "≠": r"$\neq$",
    "≈": r"$\approx$",
    "°": r"\textdegree{}",
    "µ": r"$\mu$",
    "≥": r"$\geq$",
    "≤": r"$\leq$",
    "→": r"$\rightarrow$",
    "∞": r"$\infty$",
    "\n": " ",
} | {_greek(name): rf"$\{name}$" for name in _GREEK}

_NOT_IN_T1 = "ĦħĸĿŀŉŦŧ"
"""Between À and ž; all others there the T1 fonts have."""

_HEAD = r"""% One figure a case. It compiles as it is (pdflatex appendix.tex); for a paper, copy
% what stands between \begin{document} and \end{document}. Only graphicx is needed.
\documentclass{article}
\usepackage[T1]{fontenc}
\IfFileExists{lmodern.sty}{\usepackage{lmodern}}{}
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
    """Plain words as LaTeX: special signs by name, accents kept, strange signs by their number."""
    return "".join(
        _SPECIAL.get(sign) or _known(sign) for sign in unicodedata.normalize("NFC", text)
    )


def _known(sign: str) -> str:
    """What the T1 fonts have passes; what they lack would stop the compiler."""
    if sign.isascii() or sign.isspace():
        return sign if sign.isprintable() else " "
    if "À" <= sign <= "ž" and sign not in _NOT_IN_T1:
        return sign
    plain = unicodedata.normalize("NFKD", sign)[0]
    return plain if plain.isascii() and plain.isalpha() else f"[U+{ord(sign):04X}]"
