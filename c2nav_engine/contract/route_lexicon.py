"""The words that the English route parser knows: verbs, directions, and what names no landmark.

A *landmark* is any word that none of these lists holds: the lists are the closed classes of
English and the vocabulary of motion, so an unknown word ("jacuzzi", "dinning") is a landmark.
"""

from __future__ import annotations


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


MOTION_VERBS = _words(
    "go walk move continue proceed travel head step enter exit leave pass cross follow climb "
    "ascend descend take make get reach approach keep start begin run traverse advance return "
    "come circle wander stroll look find use hit bear stick ignore jog push open"
)
TURN_VERBS = _words("turn veer hang pivot rotate spin swing curve angle face swerve twist")
STOP_VERBS = _words("stop wait stand halt pause finish end stay remain rest park")
VERBS = MOTION_VERBS | TURN_VERBS | STOP_VERBS


def _gerund(verb: str) -> str:
    if verb in {"stop", "get", "run", "begin", "hit", "swim", "spin", "jog"}:
        return f"{verb}{verb[-1]}ing"
    return f"{verb.removesuffix('e')}ing"


STOP_GERUNDS = _words("stopping waiting halting pausing finishing ending")
GERUNDS = frozenset(_gerund(verb) for verb in VERBS) | STOP_GERUNDS

RUN_ON_VERBS = _words("turn go walk continue proceed stop wait enter take make")
"""Verbs that open a clause even where its writer left out every comma and "and"."""

CLAUSE_OPENERS = _words(
    "and then next now finally again immediately just also slowly directly quickly promptly "
    "slightly you will you'll please simply but so afterwards afterward"
)
"""Words that may stand between a boundary and the verb of its clause."""

SUBORDINATORS = _words("after once when as upon while if")
"""Openers of a clause that says when the next one holds ("once you reach the rug, …")."""

ORDINALS = _words(
    "first second third fourth fifth sixth seventh eighth ninth tenth last next final 1st 2nd 3rd"
)
NUMBERS = _words("one two three four five six seven eight nine ten twelve few couple several")
DETERMINERS = (
    _words("the a an this that these those your its his her their each every another any some")
    | ORDINALS
    | NUMBERS
    | _words("top bottom upper lower small large big")
)
"""After one of these a verb's word is a noun: "the exit", "a step"."""

NO_RUN_ON_AFTER = (
    DETERMINERS
    | CLAUSE_OPENERS
    | _words(
        "to can should must would could may might don't not or i we they it who which before "
        "until till when where once after if as sharp slight hard quick immediate by without"
    )
)
"""Before a verb these show that it does not open a clause: "to enter", "you go", "sharp turn"."""

POINTING_BACK = _words("it them there here that those these this")
"""A clause with one of these and no landmark belongs to the clause before."""

_FUNCTION_WORDS = _words(
    "the a an this that these those your you you'll you're you've yourself it it's its he she "
    "they them their his her i me my we our us there here who which what where when while how "
    "and or but so if then than as because both either neither each every all any some no not "
    "none other another same such more most less least much many few several couple bit little "
    "lot is are was were be been being am has have had do does did done will would can could "
    "should shall may might must don't can't won't isn't let lets let's also just only even still "
    "now again once after before until till upon since during too very almost nearly about "
    "approximately around of to in into inside on onto at by with without within from for "
    "through throught thru though throughout past passed passes pasts between beside besides "
    "near next behind beyond "
    "beneath below under underneath over above across along alongside against off out outside "
    "toward towards up down upon via away another one's that's there's onwards see sees seen "
    "visible soon please need want able"
)
_DIRECTIONS = _words(
    "left right lefthand righthand left-hand right-hand leftmost rightmost straight strait "
    "forward forwards backward backwards back ahead onward upward upwards downward downwards "
    "sharp sharply slight slightly hard soft quick quickly immediate immediately immediatly "
    "direct directly diagonal diagonally parallel opposite clockwise counterclockwise degree "
    "degrees ninety forty thirty turn turns turned way direction directions path route side "
    "sides end ends edge top bottom base middle center centre front rear far close closer "
    "closest near nearest nearer halfway midway half part point place spot position destination "
    "location here hand further farther farthest furthest feet foot meter meters metre metres "
    "inches yards ft m paces distance time o'clock finally completely entire entirely whole "
    "fully simply slowly promptly facing faced finished first-left clear beginning start length"
)
_INFLECTED_VERBS = frozenset(
    form for verb in VERBS for form in (f"{verb}s", f"{verb}es", f"{verb}ed", f"{verb}d")
) - _words("stands steps ends opens heads passes faces crosses uses runs")
NOT_LANDMARKS = (
    _FUNCTION_WORDS | _DIRECTIONS | ORDINALS | NUMBERS | VERBS | GERUNDS | _INFLECTED_VERBS
)
