"""Commands as people say them in the form of commands: clauses without politeness, remarks, wishes and gifts."""

from __future__ import annotations

import re

from diorama_core.errors import EditRefused
from diorama_core.text.foreign_words import to_english
from diorama_core.text.looks import look_of
from diorama_core.text.phrases import noun_phrase, split_places

VERBS = {
    "remove": "remove|delete|take away|take out|take down|take off|get rid of|throw out|throw away|clear away|erase"
    "|drop",
    "clear": "clear|empty|tidy",
    "turn": "turn|rotate|face|point|orient|aim|spin",
    "swap": "swap|replace|exchange|switch|substitute",
    "change": "change",
    "paint": "paint|colour|color|recolour|recolor|dye",
    "make": "make",
    "larger": "enlarge|scale up|grow",
    "smaller": "shrink|scale down|reduce",
    "lift": "raise|lift|lower",
    "move": "move|shift|push|pull|drag|bring|slide|relocate|carry",
    "put": "put|try|place|set|hang|stand|lay|position|arrange|line up|cent(?:er|re)",
    "insert": "add|insert|give me|i want|we want|i would like|i'd like|we'd like|i'd love|i need|we need"
    "|there should be|create|get|bring in|have",
}
_ANY_VERB = "|".join(VERBS.values())
_OTHER_VERB = (
    r"(?:take|give|lock|unlock|hide|show|open|close|shut|duplicate|copy|clone|rename|call|align|straighten|level|space"
    r"|dim|brighten|widen|lengthen|extend|cover|repaint) (?:the|all|every|each|my|this|it|them|these|those)"
)
_ASKED = r"(?:please |can you |could you |can we |let's )*"
_BEGINS = rf"(?={_ASKED}(?:(?:{_ANY_VERB})\b|{_OTHER_VERB}\b))"
_CLAUSES = re.compile(
    rf"\s*(?:;|:(?!\d)|[.!?](?!\d)|,?\s*\b(?:and )?then\b|,?\s*\b(?:and|so|but)\s+{_BEGINS}|,\s*{_BEGINS})\s*"
)
_SHOULD = re.compile(
    r"^(?:please )?((?:the|all|every|each|my|these|those) .+?) (?:should|must|ought to|ha(?:s|ve) to)(?: be)? "
)
_POLITE = re.compile(
    r"^(?:(?:please|now|then|also|and|hey|ok|okay|well|maybe|perhaps|can you|could you|can we|could we|would you"
    r"|will you|let's|let us|i would like you to|i'd like you to|i want you to|i want to|i'd like to|i would like to"
    r"|we want to|we'd like to|go ahead and|just),? )+"
)
_AT_END = re.compile(r",? (?:please|for me|thanks|thank you|now|instead|\?)$|\?$")
_GIVEN = re.compile(
    r"^give ((?:the|my|all|each|every) .+?) (an?|some|one|two|three|four|five|six) (.+?)"
    r"(?: colou?r| finish| look| covering)?$"
)
"""“give the sofa a dark green colour”; the walls, too."""
_WANTED = re.compile(
    r"^(?:i|we)(?: want| would like|'d like|'d love| need|(?:'d| would)? (?:prefer|rather have))"
    r" ((?:the|my|this|these|those|all|both) .+?)"
    r"(?: to (?:be |(?=face |look |point ))(.+))?$"
)
_MAY = re.compile(
    r"^(?:can|could|may) ((?:the|all|every|each|my|this|these|those) .+?) (?:(be|have|get)|go|stand|hang|sit|lie) "
)
_HAVE_FACE = re.compile(r"^(?:have|let) ((?:the|my|all|both) .+?) (?=(?:face|look|point)\b)")
_GONE = re.compile(r"^(?:make|want|have|get) (.+?) (?:be )?(?:gone|removed|deleted|out of here)$")
_ATTRIBUTE = re.compile(r"\b((?:the|my|this|its) [\w -]+?)'s (?=(?:colou?r|width|height|depth|length)\b)(\w+)")
_COLOUR_OF = re.compile(r"^(?:change|make|set|turn) the colou?r of (.+?) (?:to|into|be) ")
_SO_IT_IS = re.compile(r"\bso (?:that )?(?:it|they)(?:'s|'re| is| are)?(?: right)? ")
_ANYTHING = re.compile(r"\b(?:anything|whatever)(?: (?:that is|that's|is))?\b")
_FILLED = re.compile(r"^fill (.+?) with (?:some )?(?!a |an |one )(.+)$")
_TAKEN = re.compile(
    r"^(?:take|get) ((?:the|my|all|every|both|those|these|this|that|it|them|everything)\b.*?)"
    r" (?:off|down|out|away|from)(?: of| from)?(?: ((?:the|my|its|their) .+))?$"
)
_PICKED_UP = re.compile(
    r"^(?:take|grab|pick up|get) ((?:the|my|both|those|these|this|that) .+?)"
    r"(?: (?:off|down|out|away|from)(?: of| from)?(?: ((?:the|my|its|their) .+))?)?$"
)
_SET_DOWN = re.compile(r"^(?:put|place|set|move|hang|stand|lay|bring) (?:it|them) ")
_ORIGIN = re.compile(
    r"(?<!away)(?<!apart)(?<!across)(?<!ther)(?<![ \d]m)(?<!cm)(?<!metre)(?<!metres)(?<!meter)(?<!meters)"
    r" (?:from|off)(?: of)? (?=(?:the|my|this|its) )"
)
_OVER = re.compile(r"\bover (?=(?:to|by|next|near|beside|there|in front)\b)")
_REMARK = re.compile(
    r"^(?:i (?:think|find|feel) )?(?:that )?((?:the|my|our|this|these|those|all) [\w' -]+?)"
    r" (?:is|are|looks?|seems?|feels?) (.+)$"
)
_LIKED = re.compile(
    r"^(?:i|we) (?:(?:really|just) )?(?:do not|don't|never|hate|dislike|am tired of|are tired of|no longer)"
    r"(?: (?:really|even))?(?: (?:like|love|need|want|use))? ((?:the|my|this|that|these|those) [\w' -]+?)"
    r"(?: any ?more| at all)?$"
)
_COPY = re.compile(r"\bthe (?:copy|copies|new one|new ones|duplicate)\b")
_PRONOUN = re.compile(r"\b(?:it|them|that one|this one)\b")
_CURES = {
    "small": "bigger", "little": "bigger", "tiny": "bigger", "big": "smaller", "large": "smaller", "huge": "smaller",
    "low": "higher", "high": "lower", "tall": "shorter", "short": "taller", "long": "shorter", "wide": "narrower",
    "narrow": "wider", "dark": "brighter", "bright": "darker", "light": "darker",
}  # fmt: skip
"""What something is made that is too much so."""
EXAMPLES = (
    "make all chairs wooden; move the lamp beside the sofa; make the sofa 2 m wide; brick walls; a rug under the table"
)
MAX_COMMAND_CHARS = 1000


def clauses_of(command: str) -> tuple[str, ...]:
    """The clauses of a command, each of which is one edit or several.

    Raises:
        EditRefused: there are no words, or too many.
    """
    text = " ".join(to_english(command).lower().replace("’", "'").split()).strip(" .!")
    if not text:
        raise EditRefused(f"there is no command; for example: {EXAMPLES}")
    if len(text) > MAX_COMMAND_CHARS:
        raise EditRefused(f"the command has {len(text)} characters; {MAX_COMMAND_CHARS} are enough")
    return _without_remarks([c.strip(" ,") for c in _CLAUSES.split(text) if c.strip(" ,")])


def plain(clause: str) -> str:
    """A clause without what is only polite, in the form of a command."""
    clause = _COPY.sub("it", _POLITE.sub("", _AT_END.sub("", clause)).strip())
    clause = _OVER.sub("", _SHOULD.sub(r"make \1 ", _MAY.sub(_command, _HAVE_FACE.sub(r"make \1 ", clause))))
    clause = _COLOUR_OF.sub(r"make \1 ", _ATTRIBUTE.sub(r"the \2 of \1", _SO_IT_IS.sub("", clause)))
    clause = _FILLED.sub(r"add several \2 on \1", _ANYTHING.sub("everything", clause))
    if (given := _GIVEN.match(clause)) is not None:
        who, number, what = given.groups()
        phrase, _ = noun_phrase(what)
        names = phrase is not None and phrase.label and look_of(what) is None
        return f"add {number} {what} to {who}" if names else f"make {who} {what}"
    if (wanted := _WANTED.match(clause)) is not None:
        verb = "put" if wanted[2] is None and split_places(wanted[1])[1] else "make"
        clause = " ".join(w for w in (verb, wanted[1], wanted[2]) if w)
    if (taken := _TAKEN.match(clause)) is not None:
        return f"remove {_phrase(taken)}"
    return _ORIGIN.sub(" on ", _GONE.sub(r"remove \1", clause))


def _command(asked: re.Match[str]) -> str:
    """ "can the walls be green" and "could the piano go by the window" as commands."""
    return f"make {asked[1]} " if asked[2] else f"put {asked[1]} "


def _without_remarks(clauses: list[str]) -> tuple[str, ...]:
    """Clauses of which those that only say what they are about are said by the next one: "I don't like the rug, remove
    it" is "remove the rug"; "the room is too dark" alone is "make the room brighter"."""
    remarks, about = list[str](), ""
    for index, clause in enumerate(clauses):
        last = index + 1 == len(clauses)
        if about:
            clause, about = _PRONOUN.sub(about, clause, count=1), ""
        taken = _PICKED_UP.match(_POLITE.sub("", clause))
        if taken is not None and not last and _SET_DOWN.match(clauses[index + 1]):
            about = _phrase(taken)
            continue
        if re.match(rf"^{_BEGINS}", clause) is None:
            remark = _REMARK.match(clause) or _LIKED.match(clause)
            if remark is not None and not last:
                about = remark[1]
                continue
            clause = _cure(remark) or clause
        remarks.append(clause)
    return tuple(remarks)


def _phrase(taken: re.Match[str]) -> str:
    """Phrase for what is taken, with what it is on."""
    return taken[1] if taken[2] is None else f"{taken[1]} on {taken[2]}"


def _cure(match: re.Match[str] | None) -> str | None:
    if match is not None and match.re is _LIKED and re.search(r"need|want|use", match[0][: match.start(1)]):
        return f"remove {match[1]}"
    if match is None or match.re is not _REMARK:
        return None
    too = re.fullmatch(r"(?:far |much |a bit |way )*too (\w+)", match[2])
    return f"make {match[1]} {_CURES[too[1]]}" if too is not None and too[1] in _CURES else None
