"""How far a word of a mood reaches: the clause that it governs, and whether the act stands there.

A sentence is cut into clauses at its commas and stops, and where a word opens one: a reason ("since"), somebody
("who"), a consequence ("so"), a contrast ("but"). A clause of reason or about somebody keeps its words to itself; so
does a full clause about the past, for what happened yesterday says nothing of the order behind it. A mere adverbial
("tomorrow at nine") governs its whole sentence. What was said or is wished ends with its clause, unless a colon or a
"that" goes on, a tag reaches back ("…, he said"), or an order takes it up ("so do it"). What is to come leaves an order
alone that follows from it, or that is for now. An act is doubted where a part of it stands only within such a reach.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from wirelessagent.language.command_cues import cues_in
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.linear_model import shipped_model
from wirelessagent.language.mentions import mentions
from wirelessagent.language.moods import Span, places, table_of
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import CLAUSE_END, is_chinese, normalise

_OF_AIMS = (("up", "down", "fair", "fairly", "balance"), ("rate", "power", "efficiency", "worst"))
"""Concepts by whose words an aim is placed that no phrase names, the surer ones first."""
_FAIR, _FAIR_AIMS = ("fair", "fairly"), ("proportional_fairness", "max_min_rate")
"""Concepts that place none but these aims."""
_READ = ("negation", "refusal", "past", "time", "condition")
"""Moods whose words may be a part of a limit or of an aim that was read."""
_STORIES = ("report", "others")
"""Moods of what is told, which may go on into the next clause."""
_TAKEN_UP = (*_STORIES, "past", "quotation")
"""Moods of what an order behind it may take up."""
_ASIDE = ("because", "who", "agreed", "tell")
"""What opens a clause that keeps its words to itself."""
_SHORT = 12
"""Letters, beside its own, of an adverbial that may stand behind what it governs; a Chinese sign counts as four."""
_SPEAKS_FOR_IT = 0.45
"""How sure the model must be that a clause alone is a wish for the aim: as sure as a sentence that is acted upon."""
_LONGEST_NAME = 5
"""Chinese signs of somebody who is no user; what is longer is a story."""
_DASH = deferred(r"\s[-–—]+\s")
_SENTENCE_END = deferred(r"[!?;\n。；…]|\.(?!\d)")
_CUT = deferred(CLAUSE_END)


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """A word of a mood that nothing accounts for, where it stands."""

    mood: str
    reach: str
    start: int
    end: int


@dataclass(frozen=True, kw_only=True)
class Clause:
    """A clause, the class of the word that opens it ("because", "who", "so", "contrast" or ""), and the sign behind."""

    start: int
    end: int
    opens: str
    behind: str


class Reach:
    """What the reader made of a sentence: its clauses, where the act stands, and the words that it accounts for."""

    def __init__(self, sentence: Sentence, dropped: Sequence[Span], intent: Intent, language: str) -> None:
        self._table, self._intent = table_of(language), intent
        self._plain = plain = _DASH.sub(lambda cut: ",".ljust(len(cut[0])), sentence.plain)
        self._figures = sentence.reading.masked
        self._aim, self._terms, self._judged = list[Span](), list[Span](), list[Span]()
        self._own = list(places(self._table["own"]["words"], plain))
        self._read, self._counted = [*self._figures, *sentence.goal.spans, *dropped], sentence.reading.counted
        self._left_out = [span for part in self._parts_of("leave_out") for span in part]
        self._clauses = list(self._cut())
        self._parts, self._placed = self._act(sentence)

    def accounts_for(self, hit: Doubt) -> bool:
        """Whether a word is a part of what was read, or denies an order or service: "mustn't exceed 10 W"."""
        clause = self._of(hit)
        order = bool(self._found("order", clause))
        if hit.mood == "negation" and self._plain[hit.end : hit.end + 2].strip()[:1].isdigit() and not order:
            return False  # "give him no 2 W"
        spans = [*self._own, *self._read] if hit.mood in _READ else self._own
        if hit.mood in _READ and hit.mood != "time":  # "in two hours" counts hours, and says when
            spans = [*spans, *self._counted]
        if any(start <= hit.start and hit.end <= end for start, end in spans):
            return True
        if hit.mood == "others" and (
            self._adjoins("self", "before", hit) or self._adjoins("self", "after", hit, after=True)
        ):
            return True  # "I'd appreciate"
        if hit.mood == "others" and self._is_first(hit, clause):
            return True  # "quisiera", with nobody before it
        if hit.mood in ("condition", "past") and self._is_polite(hit, clause):
            return True
        if hit.mood == "time" and self._is_no_start(hit, clause):
            return True
        if hit.reach == "first":
            return not self._opens_a_condition(hit, clause)
        if hit.mood != "negation":
            return False
        if any(_overlap((clause.start, clause.end), span) for span in self._left_out):
            return True
        figure = any(clause.start <= first < clause.end for first, _ in self._figures)
        return figure and order

    def _opens_a_condition(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a verb stands where "if" would, before a comma: "fällt das Netzteil aus, …"."""
        ahead = self._plain[self._sentence(hit)[0] : hit.start]
        return not _worded(ahead) and clause.behind in (",", "，")

    def _is_no_start(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a time is now, or one until or since which something holds, or a figure: "at ten watts"."""
        span = (hit.start, hit.end)
        if any(_overlap(span, figure) for figure in self._figures):
            return True
        if any(start < hit.start or start == hit.end for start, _ in self._found("until", clause)):
            return True
        if self._adjoins("negation", "clause", hit) and not self._is_full(clause, hit):
            return True  # "not later, now"
        cleft = self._adjoins("that", "words", hit, after=True)  # "c'est lundi que …"
        return self._adjoins("present", "words", hit) and not cleft

    def _is_first(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a verb that may be the speaker's own is the first word of its sentence."""
        said = self._plain[self._sentence(hit)[0] : hit.start]
        return hit.start in {start for start, _ in self._found("self", clause, "first")} and not _worded(said)

    def _is_polite(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a condition is one of courtesy: "if it's no trouble", "I'd be grateful if it did not exceed 17 W"."""
        said = self._found("courtesy", clause)
        ifs = [start for reach in self._table["condition"] for start, _ in self._found("condition", clause, reach)]
        if hit.mood == "condition" and not _worded(self._plain[clause.start : hit.start]):
            before = [each for each in self._clauses if each.end == clause.start and clause.behind != "?"]
            said = [place for each in before for place in self._found("courtesy", each)] + said
        if not said or not ifs:
            return False
        ahead = any(start <= first for start, _ in said for first in ifs)
        return ahead or not any(_overlap((clause.start, clause.end), place) for part in self._parts for place in part)

    def _adjoins(self, name: str, reach: str, hit: Doubt, *, after: bool = False) -> bool:
        """Whether a word of a class stands right before a hit, or right after it."""
        found = self._found(name, self._of(hit), reach)
        gaps = ((hit.end, start) if after else (end, hit.start) for start, end in found)
        return any(first <= last and not self._plain[first:last].strip() for first, last in gaps)

    def touches(self, hit: Doubt) -> bool:
        """Whether a part of the act stands nowhere but where a word reaches; what follows its clause anew is free."""
        clause = self._of(hit)
        if hit.mood == "negation":
            return self._is_denied(hit, clause)
        if hit.mood in _TAKEN_UP and self._is_taken_up(clause):
            return False
        if hit.mood == "elsewhere" and self._turns_here(clause):
            return False
        reach = (hit.start, hit.end) if hit.reach == "inside" else self._reach(hit, clause)
        free = 0 if clause.opens in _ASIDE or self._intent.kind == "command" else clause.end
        aside = [(each.start, each.end) for each in self._clauses if each.opens in _ASIDE]
        held = [reach, *aside]
        return any(
            any(_overlap(place, reach) for place in part)
            and all(place[0] < free or any(_overlap(place, span) for span in held) for place in part)
            for part in self._parts
        )

    def foreign_subject(self) -> Doubt | None:
        """Who the aim is told of, where that is neither the operator nor the cell: "the landlord is after max rate".

        Somebody stands as the subject where, before the aim in its clause, a finite verb follows a word that no wish
        of an operator's own begins with; a user, a figure or a word for an aim is no such word.
        """
        found = [self._subject_before(*place) for place in self._aim]
        return found[0] if found and all(found) else None

    def _subject_before(self, start: int, end: int) -> Doubt | None:
        """Who stands as the subject of one place of the aim, and is nobody who may ask for it."""
        table, clause = self._table["subject"], next(each for each in reversed(self._clauses) if each.start <= start)
        terms = [at for at, _ in self._terms if clause.start <= at < end]
        whole = (start, end) == (clause.start, clause.end) or end >= len(self._plain.rstrip(" .!。"))
        head = self._plain[clause.start : min(terms, default=clause.end) if whole and start == clause.start else start]
        finite = list(places(table["finite"], head))
        if clause.opens in _ASIDE or not finite or self._begins("imperative", clause):
            return None
        subject = head[: finite[-1][0]]
        if any(not _worded(head[:at]) for at, _ in places(table["adverbial"], head)):
            return None
        if any(places(table["speaker"], head)) or any(mentions(subject)):
            return None
        kept = list(places(table["ours"], subject))
        rest = [sign for at, sign in enumerate(subject) if not any(a <= at < b for a, b in kept)]
        if sum(map(str.isalpha, rest)) < 2 or sum(map(is_chinese, rest)) > _LONGEST_NAME:
            return None
        first = clause.start + len(head) - len(head.lstrip())
        return Doubt(mood="others", reach="clause", start=first, end=clause.start + finite[-1][1])

    def _reach(self, hit: Doubt, clause: Clause) -> Span:
        """From where to where a word reaches, by its class and the form of its clause."""
        alone, (start, end) = (clause.start, clause.end), self._sentence(hit)
        later = [each for each in self._clauses if clause.end <= each.start < end]
        full = self._is_full(clause, hit)
        if clause.opens in _ASIDE or hit.reach == "here":
            return alone
        if hit.reach == "text":
            beside = self._plain[clause.start : hit.start] + self._plain[hit.end : clause.end]
            if self._intent.kind == "command" and hit.mood == "refusal" and _worded(beside):
                return alone  # "I didn't mean that, undo it"
            last = len(self._plain)
            return 0, self._next(later, "imperative", last) if self._has_object(hit, clause) else last
        if hit.reach in ("sentence", "first"):
            return start, end
        if self._begins("comment", clause):
            return start, clause.end
        told = self._goes_on(hit, clause, later)
        if hit.mood in _STORIES:
            tag = not later and not _worded(self._plain[hit.end : clause.end])
            if hit.reach == "ahead" and full and not told:
                end = self._next(later, "imperative", end)
            if (
                hit.mood == "others" and not told and hit.reach == "clause"
            ):  # "the council wants less power, 5 W at most"
                for each in later:
                    if each.opens or any(self._found(name, each) for name in ("statement", "imperative", "now")):
                        break
                    clause = dataclasses.replace(clause, end=each.end)
            return start if tag else clause.start, end if told or hit.reach == "ahead" else clause.end
        if self._is_since(hit, clause):
            return alone if full or not self._is_short(hit, clause) else (clause.start, later[0].end if later else end)
        if (hit.reach == "ahead" or hit.mood in ("elsewhere", "time", "past")) and not full:
            if self._is_short(hit, clause):
                if hit.mood == "past":
                    end = min(self._first_of(later, end, "so"), self._next(later, "imperative", end))
                return start, end
            if hit.mood == "elsewhere":
                turns = self._plain[start : clause.start].strip()
                return clause.start, self._first_of(later, end, "besides") if turns else end
            return clause.start, self._next(later, "now", end)
        if hit.mood == "time" and hit.reach == "ahead" and not told:
            return clause.start, self._next(later, "now", end)
        return clause.start, end if told and hit.mood != "elsewhere" else clause.end

    def _is_since(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a time is that since when something is so, as some words only say of the past."""
        since = self._found("since", clause) if hit.mood in ("past", "time") else []
        since += self._found("since", clause, "past") if hit.mood == "past" else []
        return any(start <= hit.start for start, _ in since)

    def _goes_on(self, hit: Doubt, clause: Clause, later: Sequence[Clause]) -> bool:
        """Whether the next clause says what is told: behind "that", or a colon that nothing else is told before."""
        ordered = hit.mood == "others" and any(each.opens == "so" for each in later[:1])  # "老板催，请…"
        signs = (":", ",", "，") if hit.mood in _STORIES and not ordered else (":",)
        behind = [end for start, end in self._found("that", clause) if not _worded(self._plain[hit.end : start])]
        if not _worded(self._plain[max(behind, default=hit.end) : clause.end]) and (behind or clause.behind in signs):
            return True
        return any(each.opens == "" and self._begins("that", each) for each in later[:1])

    def _is_denied(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a negation has the act ahead of it, or is the last word: "max rate? no"."""
        start, end = hit.end, clause.end
        if not _worded(self._plain[hit.end : end]):
            start = clause.start
            if not self._plain[start : hit.start].strip() and not self._plain[end:].strip(" .!。"):
                return True
        one = self._clauses[0].end >= len(self._plain.rstrip(" .!?。"))
        parts = self._parts if self._placed or one else []
        return any(
            (all if part is self._judged else any)(_overlap(span, (start, end)) for span in part) for part in parts
        )

    def _is_taken_up(self, clause: Clause) -> bool:
        """Whether an order behind a story carries it out: "…, give it that", "…, so meet them halfway"."""
        for each in self._clauses:
            if each.start < clause.end:
                continue
            orders = self._begins("taken_up", each) or (each.opens == "so" and not self._found("statement", each))
            said = self._found("taken_up", each)
            denied = (span for reach in self._table["negation"] for span in self._found("negation", each, reach))
            if orders and all(any(a <= start and end <= b for a, b in said) for start, end in denied):
                return True
        return False

    def _turns_here(self, clause: Clause) -> bool:
        """Whether the act stands in a clause of this cell, behind one of another: "forget the Wi-Fi, here I want …"."""
        here = [each for each in self._clauses if each.start >= clause.end and self._found("here", each)]
        behind = min((each.start for each in here), default=len(self._plain))
        return bool(here) and all(any(place[1] > behind for place in part) for part in self._parts)

    def _first_of(self, clauses: Sequence[Clause], end: int, name: str) -> int:
        """Where the first of these clauses begins that opens so, or begins with such a word."""
        found = (
            each.start for each in clauses if each.opens == name or (name == "besides" and self._begins(name, each))
        )
        return min(found, default=end)

    def _next(self, clauses: Sequence[Clause], name: str, end: int) -> int:
        """Where the next clause begins that turns, begins with a word of order, or has one of now in it."""
        for each in clauses:
            ordered = self._found(name, each) if name == "now" else self._begins(name, each)
            if each.opens in ("so", "contrast") or ordered:
                return each.start
        return end

    def _has_object(self, hit: Doubt, clause: Clause) -> bool:
        """Whether a refusal says itself what is refused, and that is not the act: "I refuse to waste watts, …"."""
        act = any(_overlap((clause.start, clause.end), place) for part in self._parts for place in part)
        behind = _worded(self._plain[hit.end : clause.end])
        return hit.mood == "refusal" and behind and not act and not self._found("anaphor", clause)

    def _is_full(self, clause: Clause, hit: Doubt) -> bool:
        """Whether a clause has a finite verb or a pronoun that is no part of an adverbial hit."""
        own, verbs = (hit.start, hit.end), self._found("statement", clause)
        return any(hit.reach == "clause" or span == own or not _overlap(span, own) for span in verbs)

    def _is_short(self, hit: Doubt, clause: Clause) -> bool:
        """Whether hardly a word stands in a clause beside a hit."""
        beside = self._plain[clause.start : hit.start] + self._plain[hit.end : clause.end]
        return sum(4 if is_chinese(sign) else sign.isalpha() for sign in beside) <= _SHORT

    def _found(self, name: str, clause: Clause, reach: str = "words") -> list[Span]:
        """Where words of a class stand in a clause."""
        first = clause.start
        found = places(self._table[name][reach], self._plain[first : clause.end])
        return [(start + first, end + first) for start, end in found]

    def _begins(self, name: str, clause: Clause) -> bool:
        """Whether a clause begins with a word of a class, perhaps behind words that lead up to it."""
        lead, starts = clause.start, {start for start, _ in self._found(name, clause)}
        for start, end in self._found("lead", clause):
            if start not in starts and not _worded(self._plain[lead:start]):
                lead = end
        return any(start >= lead and not _worded(self._plain[lead:start]) for start in starts)

    def _of(self, hit: Doubt) -> Clause:
        return next(each for each in reversed(self._clauses) if each.start <= hit.start)

    def _sentence(self, hit: Doubt) -> Span:
        ends = [match.end() for match in _SENTENCE_END.finditer(self._plain)]
        start = max((end for end in ends if end <= hit.start), default=0)
        return start, min((end for end in ends if end > hit.start), default=len(self._plain))

    def _cut(self) -> Iterator[Clause]:
        """The clauses from left to right; "since" opens one only where that has a verb."""
        plain, cuts = self._plain, {0: ("", "")}
        for cut in _CUT.finditer(plain):
            if not any(start < cut.start() < end for start, end in self._figures):
                cuts[cut.end()] = ("", cut.group())
        for name in ("who", "agreed", "tell", "so", "contrast", "because"):
            for reach, words in self._table[name].items():
                for start, end in places(words, plain):
                    last = max(place for place in cuts if place <= start)
                    behind = min((place for place in cuts if place > start), default=len(plain))
                    first = not _worded(plain[last:start])
                    kept = any(a <= start and end <= b for a, b in (*self._figures, *self._own))
                    bare = name == "because" and not any(places(self._table["statement"]["words"], plain[end:behind]))
                    if (first or reach == "words") and not kept and not bare:
                        place = last if first else start
                        cuts[place] = (name, cuts.get(place, ("", ""))[1])
        aside = any(name in ("who", "because") for name, _ in cuts.values())
        for start, _ in places(self._table["imperative"]["words"], plain) if aside else ():
            last = max(place for place in cuts if place <= start)
            joint = self._joint_before(start) if cuts[last][0] in ("who", "because") else -1
            if _worded(plain[last : max(joint, last)]):  # "qui n'a pas payé et pousse le débit"
                cuts[joint] = ("", "")
        starts = sorted(cuts)
        for start, end in zip(starts, [*starts[1:], len(plain)], strict=True):
            yield Clause(start=start, end=end, opens=cuts[start][0], behind=cuts.get(end, ("", ""))[1])

    def _joint_before(self, start: int) -> int:
        """Where an "and" begins right before a place; −1 where none does."""
        found = places(self._table["joint"]["words"], self._plain[:start])
        return next((first for first, end in found if not self._plain[end:start].strip()), -1)

    def _act(self, sentence: Sentence) -> tuple[list[list[Span]], bool]:
        """The places of each part of the act, and whether they are known by words that were read."""
        whole = (0, len(self._plain))
        if self._intent.kind == "command":
            return [cues_in(self._intent.topic or "", self._plain) or [whole]], False
        parts = [part for name in self._intent.evidence if name != "not_used" for part in self._parts_of(name)]
        placed = [part for part in parts if whole not in part]
        self._aim = [span for part in self._parts_of("objective") if whole not in part for span in part]
        if placed and len(placed) == len(parts):
            return placed, True
        self._terms = [(item.start, item.end) for item in sentence.found if item.term.concept != "domain"]
        terms = [((item.start, item.end), item.term) for item in sentence.found]
        named = [span for span, term in terms if term.objective == self._intent.objective]
        unfair = _FAIR if self._intent.objective not in _FAIR_AIMS else ()
        first, second = (
            [span for span, term in terms if term.concept in group and term.concept not in unfair] for group in _OF_AIMS
        )
        orders = [(each.start, each.end) for each in self._clauses if self._begins("imperative", each)]
        self._judged = judged = self._judged_places() if not named and (first or not placed) else []
        groups = (named, judged, first) if placed else (named, judged, first, second, orders)
        meant = next((spans for spans in groups if spans), list[Span]())
        one = sum(_worded(self._plain[each.start : each.end]) for each in self._clauses) == 1
        self._aim = self._aim or meant or ([whole] if one else [])
        return [part for part in (*placed, meant) if part] or [[whole]], bool(placed)

    def _judged_places(self) -> list[Span]:
        """The clauses that speak for the aim each by itself; none where no clause, or only one, has words."""
        worded = [each for each in self._clauses if _worded(self._plain[each.start : each.end])]
        found: list[Span] = []
        for each in worded if len(worded) > 1 else ():
            text, concepts, language = Sentence(self._plain[each.start : each.end], own_words()).for_model()
            shares = shipped_model().probabilities(text, concepts, language)
            if shares.get(self._intent.objective or "", 0.0) >= _SPEAKS_FOR_IT:
                found.append((each.start, each.end))
        return found

    def _parts_of(self, name: str) -> list[list[Span]]:
        """Where the words stand that a part of the act came from: an aim is one part, figures are one each."""
        found = [list(_occurrences(self._plain, normalise(words))) for words in self._said(name)]
        parts = [part for part in found if part]
        return [[span for part in parts for span in part]] if name == "objective" and parts else parts

    def _said(self, name: str) -> list[str]:
        return [words for words in self._intent.evidence.get(name, "").split(" … ") if words]


def _worded(text: str) -> bool:
    return any(sign.isalnum() for sign in text)


def _overlap(one: Span, other: Span) -> bool:
    return one[0] < other[1] and other[0] < one[1]


def _occurrences(plain: str, words: str) -> Iterator[Span]:
    place = plain.find(words)
    while place >= 0:
        yield place, place + len(words)
        place = plain.find(words, place + len(words))
