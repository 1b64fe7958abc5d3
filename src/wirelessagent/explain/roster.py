"""Who has what: who gets the least or the most, which subcarriers a user has, and who has a subcarrier."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.lexicon import Lexicon, listed, paragraph
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called

_SAME = 1e-3
"""A share of a figure that does not show in it."""

WORDS = Lexicon(
    english={
        "least": "{names} {gets} the least{what}: {size}{further}.",
        "most": "{names} {gets} the most{what}: {size}{further}.",
        "all_same": "All {count} users get the same{what}: {size}.",
        "nothing": "{names} {gets} nothing.",
        "of_the_rest": "Of the others, {sentence}",
        "next": "Next {is_} {names} with {size}.",
        "one": "gets",
        "several": "get",
        "is_one": "is",
        "is_several": "are",
        "of_rate": "",
        "of_power": " power",
        "of_subcarriers": " subcarriers",
        "further_rate": ", with {power} on {count} of {total} subcarriers",
        "further_power": ", for {rate} on {count} of {total} subcarriers",
        "further_subcarriers": " of {total}, for {rate} with {power}",
        "further_of_each": " each",
        "has": "{name} has {count} of the {total} subcarriers: {places} (counted from 1).",
        "has_none": "{name} has none of the {total} subcarriers.",
        "row": "{name}: {places} ({count})",
        "all": "Of {total} subcarriers, counted from 1:",
        "unused": "not used: {places} ({count})",
        "owner": "Subcarrier {place} goes to {name}, with {power}.",
        "no_owner": "Subcarrier {place} is not used.",
        "no_such": "There is no subcarrier {place}; there are 1 to {total}.",
        "range": "{first}–{last}",
        "comma": ", ",
    },
    chinese={
        "least": "{names}{gets}{what}最少：{size}{further}。",
        "most": "{names}{gets}{what}最多：{size}{further}。",
        "all_same": "{count} 个用户得到{what}一样多：{size}。",
        "nothing": "{names}什么也没有{gets}。",
        "of_the_rest": "其余用户中，{sentence}",
        "next": "其次{is_}{names}，{size}。",
        "one": "得到",
        "several": "得到",
        "is_one": "是",
        "is_several": "是",
        "of_rate": "的速率",
        "of_power": "的功率",
        "of_subcarriers": "的子载波",
        "further_rate": "，功率 {power}，占 {total} 个子载波中的 {count} 个",
        "further_power": "，速率 {rate}，占 {total} 个子载波中的 {count} 个",
        "further_subcarriers": "（共 {total} 个），速率 {rate}，功率 {power}",
        "further_of_each": "（每个）",
        "has": "{name}有 {total} 个子载波中的 {count} 个：第 {places} 个（从 1 数起）。",
        "has_none": "{total} 个子载波中没有{name}的。",
        "row": "{name}：第 {places} 个（共 {count} 个）",
        "all": "共 {total} 个子载波，从 1 数起：",
        "unused": "未使用：第 {places} 个（共 {count} 个）",
        "owner": "第 {place} 个子载波给了{name}，功率 {power}。",
        "no_owner": "第 {place} 个子载波未使用。",
        "no_such": "没有第 {place} 个子载波；共有第 1 至 {total} 个。",
        "range": "{first}–{last}",
        "comma": "、",
    },
)


def rank_answer(case: Case, rank: str, of: str, language: str) -> str:
    """Who of those served gets the "least" or the "most" of "rate", "power" or "subcarriers"."""
    users = np.flatnonzero(case.served)
    size = _sizes(case, of)[users]
    nobody = users[size <= 0]
    if rank == "most" or not nobody.size:
        return paragraph(_ranked(case, users, rank, of, language), language)
    said = [WORDS.say(language, "nothing", names=_names(case, nobody, language), gets=_gets(nobody, language))]
    some = users[size > 0]
    if some.size:
        sentence = _ranked(case, some, rank, of, language)[0]
        said.append(WORDS.say(language, "of_the_rest", sentence=sentence))
    return paragraph(said, language)


def _ranked(case: Case, users: IntArray, rank: str, of: str, language: str) -> list[str]:
    """Who of these is first, and who comes next."""
    size = _sizes(case, of)
    order = users[np.argsort(size[users] if rank == "least" else -size[users], kind="stable")]
    first, edge = _alike(order, size), float(size[order[0]])
    if first.size == users.size > 1:
        what = WORDS.say(language, f"of_{of}")
        return [WORDS.say(language, "all_same", count=users.size, what=what, size=_size(edge, of))]
    said = [
        WORDS.say(
            language, rank, names=_names(case, first, language), gets=_gets(first, language), size=_size(edge, of),
            what=WORDS.say(language, f"of_{of}"), further=_further(case, first, of, language),
        )
    ]  # fmt: skip
    rest = order[~np.isin(order, first)]
    if rest.size and size[rest[0]] > 0:
        following = _alike(rest, size)
        verb = WORDS.say(language, "is_one" if following.size == 1 else "is_several")
        names, figure = _names(case, following, language), _size(float(size[rest[0]]), of)
        said.append(WORDS.say(language, "next", is_=verb, names=names, size=figure))
    return said


def _alike(order: IntArray, size: FloatArray) -> IntArray:
    """The users at the head of ``order`` who have the same, by their numbers."""
    head = float(size[order[0]])
    return np.sort(order[np.abs(size[order] - head) <= _SAME * head])


def _further(case: Case, users: IntArray, of: str, language: str) -> str:
    """What else a user has; nothing more of several."""
    if users.size > 1:
        return WORDS.say(language, "further_of_each")
    user, decision = int(users[0]), case.decision
    return WORDS.say(
        language, f"further_{of}", total=decision.owner.size, rate=human(float(case.rate_bps[user]), "bit/s"),
        power=human(float(_sizes(case, "power")[user]), "W"), count=int(_sizes(case, "subcarriers")[user]),
    )  # fmt: skip


def subcarriers_answer(case: Case, user: int | None, language: str) -> str:
    """The subcarriers of a user, or of everybody."""
    decision, total = case.decision, case.decision.owner.size
    if user is not None:
        name, own = called(language, case.estimate.user_names[user]), _own(case, user)
        key = "has" if own.size else "has_none"
        return WORDS.say(language, key, name=name, count=own.size, total=total, places=_places(own, language))
    rows = [WORDS.say(language, "all", total=total)]
    for each in range(case.num_users):
        own, name = _own(case, each), called(language, case.estimate.user_names[each])
        if own.size:
            rows.append(WORDS.say(language, "row", name=name, places=_places(own, language), count=own.size))
    free = np.flatnonzero(decision.power_w <= 0)
    if free.size:
        rows.append(WORDS.say(language, "unused", places=_places(free, language), count=free.size))
    return "\n".join(rows)


def owner_answer(case: Case, place: int, language: str) -> str:
    """Who has a subcarrier, counted from 1."""
    decision = case.decision
    if not 1 <= place <= decision.owner.size:
        return WORDS.say(language, "no_such", place=place, total=decision.owner.size)
    power, owner = float(decision.power_w[place - 1]), int(decision.owner[place - 1])
    if owner < 0 or power <= 0:
        return WORDS.say(language, "no_owner", place=place)
    name = called(language, case.estimate.user_names[owner])
    return WORDS.say(language, "owner", place=place, name=name, power=human(power, "W"))


def _own(case: Case, user: int) -> IntArray:
    return np.flatnonzero((case.decision.owner == user) & (case.decision.power_w > 0))


def _sizes(case: Case, of: str) -> FloatArray:
    """What each user has, in bit/s, W or subcarriers, shape (user,)."""
    decision = case.decision
    if of == "rate":
        return case.rate_bps
    used = decision.power_w > 0
    weights = decision.power_w[used] if of == "power" else np.ones(int(used.sum()))
    return np.asarray(np.bincount(decision.owner[used], weights=weights, minlength=case.num_users), dtype=np.float64)


def _size(value: float, of: str) -> str:
    return f"{value:.0f}" if of == "subcarriers" else human(float(value), "W" if of == "power" else "bit/s")


def _names(case: Case, users: IntArray, language: str) -> str:
    return listed([case.estimate.user_names[int(user)] for user in users], language)


def _gets(users: IntArray, language: str) -> str:
    return WORDS.say(language, "one" if users.size == 1 else "several")


def _places(subcarriers: Sequence[int] | IntArray, language: str) -> str:
    """Subcarriers counted from 1, neighbours together: "1–3, 7"."""
    runs = np.split(np.asarray(subcarriers), np.flatnonzero(np.diff(subcarriers) > 1) + 1)
    said = [
        str(run[0] + 1) if run.size == 1 else WORDS.say(language, "range", first=run[0] + 1, last=run[-1] + 1)
        for run in runs
        if run.size
    ]
    return WORDS.say(language, "comma").join(said)
