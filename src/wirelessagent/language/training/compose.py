"""Sentences with labels, drawn from the templates: wishes among figures, stories and contrasts, and all else."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping
from pathlib import Path

from wirelessagent.language.training.grammar import Grammar, Slot

OBJECTIVES = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
LANGUAGES = ("en", "zh", "es", "fr", "de")
SURROUNDINGS = ("opener", "closer", "neutral", "constraint", "contrast", "wonder")

_NOUNS: dict[str, str] = dict(
    zip(OBJECTIVES, ("rate_noun", "power_noun", "ee_noun", "pf_noun", "mm_noun"), strict=True)
)
_RIVALS = (("max_rate", "min_power"), ("max_rate", "max_min_rate"), ("proportional_fairness", "max_min_rate"))
_TYPOS, _BARE = 0.1, 0.25
_GOES_BACK, _LIMIT_ALONE, _AIM_ALONE = 0.06, 0.25, 0.6
_PER_WISH, _PER_SITUATION, _PER_WORDS = 9.0, 4.0, 12.0


def _of(*choices: str) -> Slot:
    return lambda chance: chance.choice(choices)


def _figures(*units: str) -> Slot:
    def draw(chance: random.Random) -> str:
        number = chance.choice(("1", "2", "5", "10", "12", "20", "25", "40", "0.5", "2.5", "300", "100", "1.2"))
        return number + chance.choice(units)

    return draw


SLOTS: dict[str, dict[str, Slot]] = {
    "en": {
        "power": _figures(" W", " watts", "W", " mW", " dBm", " dBW"),
        "rate": _figures(" Mbit/s", " Mbps", " kbit/s", " megabits per second", " kbps", " Mb/s"),
        "ratio": _of("5 %", "1 %", "95 %", "99 percent", "20 %", "40%", "thirty percent"),
        "bare": _of("3", "5", "2", "10", "0.5", "7"),
        "user_ref": _of("user "
            "3", "user 5", "users 1 and 4", "user 7", "user 2", "UE 6", "users 2, 4 and 8", "the third user"),
    },
    "zh": {
        "power": _figures("瓦", "W", "瓦", "毫瓦", "dBm"),
        "rate": _figures("兆", "Mbps", "兆", "kbps", "兆比特每秒", "M"),
        "ratio": _of("5%", "百分之五", "95%", "百分之四十", "20%", "99%"),
        "bare": _of("3", "5", "2", "10"),
        "user_ref": _of("用户3", "3号", "3号用户", "用户5", "1号和4号", "用户2", "7号用户", "第三个用户"),
    },
    "es": {
        "power": _figures(" W", " vatios", " dBm", " mW"),
        "rate": _figures(" Mbit/s", " Mbps", " kbps", " megabits por segundo"),
        "ratio": _of("5 %", "95 %", "el 40 %"),
        "bare": _of("3", "2", "5"),
        "user_ref": _of("el usuario 3", "usuario 5", "los usuarios 1 y 4", "el usuario 2"),
    },
    "fr": {
        "power": _figures(" W", " watts", " dBm", " mW"),
        "rate": _figures(" Mbit/s", " Mbps", " kbit/s", " mégabits par seconde"),
        "ratio": _of("5 %", "95 %", "40 %"),
        "bare": _of("3", "2", "5"),
        "user_ref": _of("l'utilisateur 3", "l'utilisateur 5", "les utilisateurs 1 et 4", "l'utilisateur 2"),
    },
    "de": {
        "power": _figures(" W", " Watt", " dBm", " mW"),
        "rate": _figures(" Mbit/s", " Mbps", " kbit/s", " Megabit pro Sekunde"),
        "ratio": _of("5 %", "95 %", "40 %"),
        "bare": _of("3", "2", "5"),
        "user_ref": _of("Nutzer 3", "Nutzer 5", "Nutzer 1 und 4", "Nutzer 2"),
    },
}  # fmt: skip


def sentences(folder: Path, seed: int = 1) -> Iterator[tuple[str, str]]:
    """(sentence, label) for training, the same ones for a seed."""
    chance = random.Random(seed)
    for language in LANGUAGES:
        maker = _Maker(Grammar.read(folder / f"{language}.txt"), chance)
        for text, label in maker.all():
            yield (mistyped(text, chance) if chance.random() < _TYPOS else text), label


def wishes(folder: Path, language: str, chance: random.Random) -> Iterator[tuple[str, str]]:
    """What somebody may want of a cell, with its kind, without end: aims, limits, both, and at times to go back."""
    maker = _Maker(Grammar.read(folder / f"{language}.txt"), chance)
    while True:
        yield maker.wish()


def mistyped(text: str, chance: random.Random) -> str:
    """A sentence with one slip: a letter lost, doubled, or swapped with its neighbour."""
    if len(text) < 6:
        return text
    place = chance.randrange(1, len(text) - 2)
    if not text[place].isalpha() or not text[place + 1].isalpha():
        return text
    a, b = text[place], text[place + 1]
    return text[:place] + chance.choice((b + a, a, a + a + b)) + text[place + 2 :]


class _Maker:
    """Sentences of one language."""

    def __init__(self, grammar: Grammar, chance: random.Random) -> None:
        self._grammar, self._chance = grammar, chance
        self._slots: Mapping[str, Slot] = SLOTS[grammar.language]
        self._gap = "" if grammar.language == "zh" else " "
        self._comma = "\uff0c" if grammar.language == "zh" else ", "

    def wish(self) -> tuple[str, str]:
        """An aim, a limit, both, or a command that goes back, with its kind."""
        draw, language = self._chance.random(), self._grammar.language
        if draw < _GOES_BACK:
            command = self._chance.choice(("command.undo", "command.reset"))
            return self._pick(command), command
        objective = self._chance.choice(OBJECTIVES)
        aim, limit = self._plain(objective), self._pick("constraint")
        if draw < _LIMIT_ALONE:
            return limit, "clarify.limits"
        return (aim if draw < _AIM_ALONE else aim + _AND[language][0] + limit), objective

    def all(self) -> Iterator[tuple[str, str]]:
        for label, templates in self._grammar.templates.items():
            if label in SURROUNDINGS:
                continue
            objective, _, kind = label.partition(".")
            for template in templates:
                if kind == "words":
                    for _ in range(round(_PER_WORDS * math.log2(1 + self._grammar.variety(template)))):
                        yield self._words(label, template), objective
                elif objective in OBJECTIVES:
                    times = round(
                        (_PER_SITUATION if kind else _PER_WISH) * math.log2(1 + self._grammar.variety(template))
                    )
                    for _ in range(times):
                        yield self._wish(template, objective, situation=bool(kind)), objective
                else:
                    for _ in range(round(5 * math.log2(1 + self._grammar.variety(template)))):
                        yield self._other(template, label), "question.other" if label == "question.fact" else label
        yield from self._turned_round()

    def _turned_round(self) -> Iterator[tuple[str, str]]:
        """Wishes that are wondered about, refused, or at odds with each other."""
        for _ in range(60 if self._grammar.language in ("en", "zh") else 20):
            for objective in OBJECTIVES:
                wish = self._plain(objective)
                wonder = self._pick("wonder", {"wish": lambda _, wish=wish: wish})
                yield wonder + ("?" if self._chance.random() < 0.6 else ""), "question.what_if"
            for one, other in _RIVALS:
                pair = [self._plain(one), self._plain(other)]
                self._chance.shuffle(pair)
                yield self._joined(pair), "clarify.rivals"
            if self._grammar.language in _DONT:
                refused = self._chance.choice(_DONT[self._grammar.language]) + self._plain(
                    self._chance.choice(OBJECTIVES)
                )
                yield refused, "clarify.negated"

    def _joined(self, pair: list[str]) -> str:
        return self._chance.choice(_AND[self._grammar.language]).join(pair)

    def _pick(self, name: str, more: Mapping[str, Slot] | None = None) -> str:
        templates = self._grammar.templates[name]
        return self._grammar.draw(self._chance.choice(templates), self._chance, {**self._slots, **(more or {})})

    def _plain(self, objective: str) -> str:
        return self._pick(objective)

    def _wish(self, template: str, objective: str, *, situation: bool) -> str:
        chance = self._chance
        core = self._grammar.draw(template, chance, self._slots)
        if chance.random() < _BARE:
            return core
        parts = [core]
        if situation and chance.random() < 0.35:
            parts.append(self._plain(objective))
        elif not situation and chance.random() < 0.12:
            parts.insert(chance.randrange(2), self._plain(objective))
        elif not situation and chance.random() < 0.2:
            parts[0] = self._contrasted(core, objective)
        if not situation and chance.random() < 0.07:
            parts.insert(0, self._situation())
        if chance.random() < 0.3 and not situation:
            parts[0] = self._pick("opener") + self._gap + parts[0]
        for _ in range(chance.choice((0, 0, 0, 1, 1, 2, 3))):
            parts.insert(chance.choice((0, len(parts), len(parts))), self._pick("constraint"))
        if chance.random() < 0.15:
            parts.insert(0, self._pick("neutral"))
        if chance.random() < 0.2:
            parts[-1] += chance.choice((self._gap, self._comma)) + self._pick("closer")
        text = parts[0]
        for part in parts[1:]:
            text += (
                chance.choice((self._comma, self._comma, *_AND[self._grammar.language], self._gap or self._comma))
                + part
            )
        return self._as_question(text)

    def _as_question(self, text: str) -> str:
        """A polite request often ends like a question: "could you …?"."""
        polite = text.lower().startswith(_POLITE) or text.endswith(("吗", "好吗"))
        return text + "?" if polite and self._chance.random() < 0.6 else text

    def _words(self, label: str, template: str) -> str:
        """A few words of an objective among small words, in any order."""
        chance, small = self._chance, _SMALL[self._grammar.language].split()
        parts = [self._grammar.draw(template, chance, self._slots)]
        parts += [self._pick(label) for _ in range(chance.choice((0, 1, 1)))]
        parts += chance.sample(small, chance.randrange(2, 7))
        chance.shuffle(parts)
        if chance.random() < 0.3:
            parts.insert(chance.choice((0, len(parts))), self._comma.strip() + self._pick("constraint"))
        return self._gap.join(parts)

    def _situation(self) -> str:
        """The story of any objective, which a plain wish overrules."""
        names = [name for name in self._grammar.templates if name.endswith(".situation")]
        return self._pick(self._chance.choice(names)) if names else self._pick("neutral")

    def _contrasted(self, wish: str, objective: str) -> str:
        other = self._chance.choice([name for name in OBJECTIVES if name != objective])
        noun = self._grammar.draw(f"<{_NOUNS[other]}>", self._chance, self._slots)
        contrast = self._pick("contrast", {"other": lambda _: noun})
        if self._chance.random() < 0.6 or contrast.endswith((",", ":", "\uff0c")):
            return contrast + self._gap + wish
        return wish + self._comma + contrast

    def _other(self, template: str, label: str) -> str:
        chance = self._chance
        text = self._grammar.draw(template, chance, self._slots)
        kind = label.partition(".")[0]
        if chance.random() < (0.2 if kind != "question" else 0.1):
            text = self._pick("opener") + self._gap + text
        if chance.random() < 0.15:
            text += chance.choice((self._gap, self._comma)) + self._pick("closer")
        if label in ("clarify.opposite", "clarify.negated", "clarify.rivals") and chance.random() < 0.3:
            text += self._comma + self._pick("constraint")
        text = self._as_question(text) if kind != "question" or chance.random() > 0.7 else text + "?"
        if chance.random() < 0.05:
            text = self._pick("neutral") + self._comma + text
        return text


_SMALL = {
    "en": "make it the cell please we want should be as with for today everyone get give so and of to them this "
    "that can in "
    "let have need go keep all what you our just by me let's on network users when up do",
    "zh": "请 把 小区 要 就 给 我 的 了 吧 今天 大家 用户 一下 都 让 来 网络 就行 尽量 现在 可以 这个 按 去 得 能 "
    "我们 先",
    "es": "que la celda por favor quiero haz todos para con los usuarios hoy el lo de una en se dame red pon y",
    "fr": "que la cellule s'il te plaît je veux fais tous pour avec les utilisateurs aujourd'hui le de une en "
    "donne réseau et",
    "de": "die Zelle bitte ich will mach alle für mit den Nutzern heute das es so auf ein sollen gib Netz und wir",
}
_POLITE = (
    "can ", "could ", "would ", "will ", "能不能", "能否", "可以", "可不可以", "puedes", "podrías", "peux-tu",
    "pourrais",
    "pouvez", "kannst", "könnte",
)  # fmt: skip
_DONT = {
    "en": (
        "don't ",
        "do not ",
        "please don't ",
        "never ",
        "I don't want to ",
        "there's no need to ",
        "stop trying to ",
    ),
    "zh": ("不要", "别", "先别", "不用", "今天别", "没必要"),
    "es": ("no quiero ", "no hace falta "),
    "fr": ("je ne veux pas ", "pas besoin de "),
    "de": ("ich will nicht ", "es ist nicht nötig: "),
}
_AND = {
    "en": (" and ", "; ", ". ", ", and ", " but ", " with ", ", "),
    "zh": ("\uff0c", "\uff0c同时", "。", "\uff0c并且", "\uff1b"),
    "es": (" y ", ". ", "; ", ", pero "),
    "fr": (" et ", ". ", " ; ", ", mais "),
    "de": (" und ", ". ", "; ", ", aber "),
}
