"""Lines that change what was said before: "make that user 3", "no, I meant 2 Mbit/s", "user 2 needs no limit any more".

What "that" refers to is what the last request stated. Users whose own figure goes are written out, as the request has
no figure for "nothing": 1 Mbit/s for everybody but user 2 is 1 Mbit/s for each of the others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from wirelessagent.language import forms
from wirelessagent.language.conversation.assent import is_assent
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.returning import read_return
from wirelessagent.language.deferred import deferred
from wirelessagent.language.followups import joined, merged, numbers_of, taken_in
from wirelessagent.language.intent import COMMANDS, EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, Constraint, Intent

CORRECTING = (
    r"(?:nope|no|sorry|oops|wait|hmm|actually|rather|instead|i\s+(?:meant|mean|said)|correction|make\s+(?:it|that|this)|"
    r"(?:it|that|this)\s+(?:should|must)\s+be|should\s+(?:be|have\s+been)|change\s+(?:it|that|this)\s+to|"
    r"(?:it's|that's|it\s+is|that\s+is|that\s+was)|不对|不是|不|说错了|搞错了|错了|其实|我是说|我说的是|我的意思是|我是指|"
    "我指的是|应该是|应当是|应该|改成|改为|换成|抱歉|对不起|更正)"
)
BESIDE = r"(?:for|to|the|one|of|be|与|给|的|是|[,，\s])"
_BOUND = r"(?:at\s+least|at\s+most|至少|最多|不超过)"
CORRECTS = deferred(rf"{CORRECTING}")
_THAT_USER = deferred(
    rf"(?:{CORRECTING}|{BESIDE})*+@(?:[,，\s]*(?:instead|then|才对|才是))?"
    r"(?P<not>[,，\s]*(?:and\s+)?(?:not|而?不是|rather\s+than|instead\s+of)\s*@)?|"
    r"(?P<other>(?:not|不是)\s*@[,，\s]*(?:but\s+(?:rather\s+)?|是|而是)?\s*@)"
)
_THAT_FIGURE = deferred(rf"(?:{_BOUND}|{CORRECTING}|{BESIDE})*+#(?:[,，\s]*(?:instead|then|才对))?")
_BARE = deferred(
    rf"(?:{_BOUND}|{CORRECTING}|{BESIDE}|yes|about|say|min(?:imum)?|max(?:imum)?|and|和|就|嗯|好|用|要)*+#"
    rf"(?:(?:and|和|[,，\s]|{_BOUND})*+#)*+(?:以上|以内|就行|就好|就可以|吧|at\s+least|at\s+most|[,.\s])*+"
)
_NO_LONGER = (
    r"(?:(?:does\s+not|doesn't|do\s+not|don't|did\s+not|didn't)\s+(?:need|want|require|have\s+to\s+(?:have|get))\b.*|"
    r"(?:no\s+longer|not)\s+(?:need|require|want|get|have|promised?|guaranteed?)s?\b.*|"
    r"(?:needs?|requires?|gets?|has|have)\s+no\b.*|(?:can|may)\s+(?:do|go|live)\s+without\b.*|"
    r"(?:is|are)\s+(?:no\s+longer|not)\s+(?:promised|guaranteed|limited|capped|needed)\b.*)"
)
_LIMIT = (
    r"(?:(?:min(?:imum)?|max(?:imum)?|guaranteed|promised|own|data|rate|speed)\s+)*(?:rates?|speeds?|floors?|guarantees?|promises?|"
    r"limits?|caps?|ceilings?|minimum|maximum|requirements?|restrictions?|weights?|priority|#)"
)
_DROP = (
    r"(?:drop|remove|lift|forget(?:\s+about)?|cancel|delete|clear|waive|take\s+away|scrap|get\s+rid\s+of|"
    r"no(?:\s+more)?|without)"
)
_ZH_LIMIT = (
    "(?:的?(?:最低|最小|最高|最大|保证|保底)?的?(?:速率|速度)?的?(?:要求|保证|下限|上限|限制|约束|限速|保底|速率|权重|优先级)|"
    "的?#)"
)
_ZH_DROP = "(?:取消|去掉|不要|解除|拿掉|撤掉|放开|删除|删掉|撤销|移除)(?:掉|了)?"
_FREED = deferred(
    rf"(?:(?:now|actually|also)\s+)?(?:@\s+{_NO_LONGER}|{_DROP}\s+(?:the\s+)?(?:@'?s?\s+{_LIMIT}|{_LIMIT}\s+(?:of|for|on|from)\s+@))"
    r"(?:\s+(?:any\s?more|any\s+longer|now))?|"
    rf"(?:现在)?@(?:已经|现在)?(?:不再|不|不用|不必|无需|无须)(?:再)?(?:需要|要|用|必)?(?:保证|限制|有|满足|达到|至少|最多)*(?:{_ZH_LIMIT})?(?:限速)?(?:了)?|"
    rf"(?:现在)?(?:不再|不用|不必|无需|不需要)(?:再)?(?:给|为|对)@(?:再)?(?:保证|限制|设)?(?:{_ZH_LIMIT})?(?:了)?|"
    rf"{_ZH_DROP}(?:对|给)?@{_ZH_LIMIT}(?:了)?|(?:把)?@{_ZH_LIMIT}(?:也|就|都)?(?:取消|去掉|不要了|解除|拿掉|撤掉|放开|删掉|删除|免了|作废)(?:掉|了)?"
)
_NOBODY = deferred(
    rf"(?:now\s+)?(?:nobody|no\s+one|no\s+user)\s+(?:needs?|requires?)\s+(?:an?\s+|the\s+|any\s+)?{_LIMIT}"
    r"(?:\s+(?:any\s?more|any\s+longer|now))?|"
    r"(?:the\s+)?(?:#|(?:min(?:imum)?\s+)?(?:rate|guarantee))\s+is\s+(?:no\s+longer|not)\s+needed(?:\s+any\s?more)?|"
    rf"(?:大家|所有人|所有用户|每个用户|谁)?都?(?:不再|不|不用)(?:需要|要)(?:保证)?{_ZH_LIMIT}了?"
)
_OF_A_LIMIT = deferred(rf"#|{_LIMIT.replace('|#', '')}|速率|速度|要求|保证|下限|上限|限制|约束|限速|保底|权重|优先级")
_CAPS = deferred(r"\b(?:max(?:imum)?|caps?|ceilings?|capped|limited)\b|at\s+most|上限|最高|最大|限速|最多|不超过")
_WEIGHTS = deferred(r"weights?|priority|权重|优先级")
_ALSO = r"(?:(?:also|and|too|as\s+well|again|back|in|now|then)\b|再|也|还|另外|同时|并且|并|请|把|将|[,，\s])"
_TAKE_IN = (
    "(?:serve|add|include|cover|admit|bring|take|加上|加入|加进来?|加进去|添加|增加|服务|纳入|包括|算上|带上|补上|"
    "接入|加)"
)
_TAKEN_IN = deferred(
    rf"{_ALSO}*+{_TAKE_IN}{_ALSO}*+@(?:{_ALSO}|to\s+(?:them|those|the\s+(?:list|users|group|others|rest)))*+"
    rf"(?:进来|进去|一起|吧)*+|{_ALSO}*+@{_ALSO}*+{_TAKE_IN}(?:进来|进去|上|吧|一起)*+"
)
_EVERYONE_IN = deferred(
    rf"(?:never\s?mind[,，.\s]+|no[,，\s]+)?{_ALSO}*+(?:serve|include|bring\s+back|take\s+back)\s+(?:everyone|everybody|all(?:\s+(?:the\s+)?"
    rf"users)?|them\s+all){_ALSO}*+|(?:算了[,，]?)?(?:大家|所有人|所有用户|全部用户|每个人|全部|全都|都)+(?:都|再)?(?:恢复|重新)?服务|"
    r"(?:算了[,，]?)?(?:恢复|重新)?服务(?:大家|所有人|所有用户|全部用户|全部)"
)
_KEPT_IN = deferred(rf"{_ALSO}*+(?:keep|retain|保留|留下|留着){_ALSO}*+@{_ALSO}*+")
_SAME_FOR = deferred(
    r"(?:the\s+)?same\s+(?:goes\s+)?for\s+@(?:\s+too)?|also\s+(?:for\s+)?@|@\s+(?:too|as\s+well|also)|"
    r"@(?:也|同样)(?:是|一样|如此|这样|照此|要|同样)*(?:处理)?"
)
_BARE_NUMBER = deferred(
    rf"(?:{CORRECTING}|{BESIDE})*+(?P<number>\d+(?:\.\d+)?)\s*(?P<prefix>[kmg])?(?:[,，\s]*(?:instead|才对))?"
)
_PREFIXES = {"k": 1e3, "m": 1e6, "g": 1e9}
_PLAUSIBLE = 100
"""How many times more or less a corrected figure may be for its unit to be clear."""
_RATES = ("min_rate_bps", "max_rate_bps")


def read_amendment(line: Line) -> Intent | None:
    """What a line changes of the request that holds or of a question that is open; None for any other line."""
    if line.context.awaits == "clarification":
        answer = _agreed(line) or _answered(line)
        if answer is not None:
            return answer
    if line.context.objective is None:
        return None
    readers = (_freed, read_return, _taken_in, _same_for, _other_user)
    if line.context.awaits != "clarification":  # what was stated last is of a line before the one that was asked about
        readers = (*readers, _other_figure, _other_number)
    for read in readers:
        intent = read(line)
        if intent is not None:
            return intent
    return None


def _agreed(line: Line) -> Intent | None:
    """A yes to "did you mean …?"."""
    context = line.context
    if context.guess is not None:
        return context.guess if is_assent(line.text) else None
    if context.offered is None or forms.plain_command(line.shape) != "confirm":
        return None
    if context.offered in COMMANDS:
        return line.command(context.offered)
    return line.allocate(context.offered, context.pending, amends=context.objective is not None)


def _answered(line: Line) -> Intent | None:
    """Bare figures after a question: they are for the users, and of the aim, that the question was about."""
    context = line.context
    objective = context.pending_objective or context.objective
    asked_about = context.pending_users or _users_with_rates(context.pending)
    if not (asked_about or context.pending_objective) or line.users:
        return None
    if not _BARE.fullmatch(line.wish) or any(figure.doubtful or figure.value <= 0 for figure in line.figures):
        return None
    values: dict[str, Constraint] = {}
    for figure in line.figures:
        rate = "max_rate_bps" if figure.comparator == "at_most" else "min_rate_bps"
        name = rate if figure.kind == "rate" else "max_power_w"
        if name in values:
            return None
        users = asked_about if figure.kind == "rate" else ()
        values[name] = dict.fromkeys(users, figure.value) if users else figure.value
    values = merged(context.pending, values)
    if objective is None:
        key = "rate_only" if "min_rate_bps" in values else "limits_only"
        return line.ask(key, values, constraints=line.voice.constraints(values))
    return line.allocate(objective, values, amends=context.objective is not None)


def _users_with_rates(pending: Mapping[str, Constraint]) -> tuple[str, ...]:
    """The users of the one rate that waits; nobody where it is everybody's, or there are several."""
    rates = [value for name, value in pending.items() if name in _RATES]
    only = rates[0] if len(rates) == 1 else None
    return tuple(only) if isinstance(only, Mapping) and EVERYBODY not in only else ()


def _other_user(line: Line) -> Intent | None:
    """ "Actually make that user 3": what was stated last is for somebody else."""
    match = _THAT_USER.fullmatch(line.wish)
    if match is None or not line.users or not CORRECTS.search(line.wish):
        return None
    users, instead_of = line.users, ""
    open_ = line.context.awaits == "clarification"
    freed = None if open_ else _freed_instead(line, users)
    if freed is not None:
        return freed
    if match["not"] or match["other"]:
        if len(users) != 2:
            return None
        users, instead_of = (users[:1], users[1]) if match["not"] else (users[1:], users[0])
    said = line.context.pending if open_ else line.context.stated
    changed = {name: _for_users(name, value, users, instead_of) for name, value in said.items()}
    moved = {name: value for name, value in changed.items() if value is not None}
    if open_ and moved:
        return line.allocate(str(line.context.objective), {**said, **moved}, amends=True)
    return _restated(line, moved) if moved else line.ask("what_of_user", users=line.voice.users(users))


def _freed_instead(line: Line, users: tuple[str, ...]) -> Intent | None:
    """The users whose limit goes in the place of those whose limit was taken off last; None where none was."""
    names, objective = line.context.user_names, str(line.context.objective)
    for name, stated in line.context.stated.items():
        held = line.context.constraints.get(name, {})
        if not isinstance(stated, Mapping) or isinstance(held, tuple):
            continue
        left = _by_user(held, names)
        if EVERYBODY in stated or numbers_of(stated, names) & numbers_of(left, names):
            continue
        before = {**left, **stated}
        gone = {
            user: figure for user, figure in before.items() if numbers_of((user,), names) & numbers_of(users, names)
        }
        rest = {user: figure for user, figure in before.items() if user not in gone}
        values: dict[str, Constraint] = {name: rest} if rest else {}
        return line.allocate(objective, values, amends=True, dropped=(name,), taken_off={name: gone}) if gone else None
    return None


def _for_users(name: str, value: Constraint, users: tuple[str, ...], instead_of: str) -> Constraint | None:
    """A statement with other users in it; None where it is about nobody, or about several in several ways."""
    if name in LISTS_OF_USERS:
        assert isinstance(value, tuple)
        kept = tuple(user for user in value if instead_of and user != instead_of)
        return tuple(dict.fromkeys((*kept, *users)))
    if name not in FIGURES_OF_USERS or isinstance(value, tuple):
        return None
    named = {user: figure for user, figure in value.items() if user != EVERYBODY} if isinstance(value, Mapping) else {}
    if instead_of in named:
        rest = {user: figure for user, figure in named.items() if user != instead_of}
        return {**rest, **dict.fromkeys(users, named[instead_of])}
    figures = set(named.values()) if isinstance(value, Mapping) else {value}
    return dict.fromkeys(users, figures.pop()) if len(figures) == 1 else None


def _other_figure(line: Line) -> Intent | None:
    """ "No, I meant 2 Mbit/s": what was stated last has another figure."""
    if len(line.figures) != 1 or line.users or not _is_another(line.wish):
        return None
    figure, stated = line.figures[0], line.context.stated
    names = _RATES if figure.kind == "rate" else ("max_power_w", "subcarrier_max_power_w", "circuit_power_w")
    held = [name for name in names if name in stated]
    if len(held) != 1 or figure.doubtful or figure.value <= 0:
        return None
    name, value = held[0], stated[held[0]]
    if figure.comparator in ("at_least", "at_most") and name in _RATES:
        name = "min_rate_bps" if figure.comparator == "at_least" else "max_rate_bps"
    if not isinstance(value, Mapping):
        return line.allocate(str(line.context.objective), {name: figure.value}, amends=True)
    if len(set(value.values())) > 1:
        users = [user for user in value if user != EVERYBODY]
        return line.ask("whose_figure", text=figure.text, users=line.voice.users(users))
    new: dict[str, Constraint] = {name: dict.fromkeys(value, figure.value)}
    return _restated(line, new) if name == held[0] else _restated(line, new, gone=held[0])


def _other_number(line: Line) -> Intent | None:
    """ "Make it 600": the figure that was stated last, in its own unit; asked about where that is not clear."""
    match = _BARE_NUMBER.fullmatch(line.wish)
    held = [name for name in ("max_power_w", *_RATES) if name in line.context.stated]
    if match is None or line.users or line.figures or len(held) != 1 or not CORRECTS.search(line.wish):
        return None
    name, stated = held[0], line.context.stated[held[0]]
    before = set(stated.values()) if isinstance(stated, Mapping) else {stated}
    if len(before) > 1 or isinstance(stated, tuple):
        return None
    old, said = float(str(before.pop())), float(match["number"])
    own = next((scale for scale in (1e9, 1e6, 1e3, 1.0, 1e-3) if old >= scale), 1e-3)
    new = said * (_PREFIXES[match["prefix"]] if match["prefix"] else min(own, 1.0) if name == "max_power_w" else own)
    if not old / _PLAUSIBLE <= new <= old * _PLAUSIBLE:
        return line.ask("unit_missing", text=match["number"])
    value: Constraint = dict.fromkeys(stated, new) if isinstance(stated, Mapping) else new
    return _restated(line, {name: value})


def _is_another(wish: str) -> bool:
    """Whether a line is a figure with words that correct one."""
    return _THAT_FIGURE.fullmatch(wish) is not None and CORRECTS.search(wish) is not None


def _restated(line: Line, new: Mapping[str, Constraint], *, gone: str = "") -> Intent:
    """The request with what was stated last taken out, and this put in its place."""
    context = line.context
    values: dict[str, Constraint] = dict(new)
    for name in {*new, *([gone] if gone else [])}:
        rest = _without(context.constraints.get(name), context.stated.get(name))
        if rest is not None:
            values[name] = joined(name, rest, new[name]) if name in new else rest
    dropped = tuple(name for name in (*new, *([gone] if gone else [])) if name in context.constraints)
    return line.allocate(str(context.objective), values, amends=True, dropped=dropped)


def _without(held: Constraint | None, stated: Constraint | None) -> Constraint | None:
    """What is left of a constraint after the last statement of it is taken out."""
    if isinstance(held, tuple) and isinstance(stated, tuple):
        return tuple(user for user in held if user not in stated) or None
    if isinstance(held, Mapping) and isinstance(stated, Mapping):
        return {user: figure for user, figure in held.items() if user not in stated} or None
    return None


def _freed(line: Line) -> Intent | None:
    """ "User 2 does not need 1 Mbit/s any more": these users' limit goes, and no other."""
    context = line.context
    if not line.users and _NOBODY.fullmatch(line.wish):
        held = [name for name in _RATES if name in context.constraints]
        return line.allocate(str(context.objective), {}, amends=True, dropped=(held[0],)) if held else None
    if not line.users or not _FREED.fullmatch(line.wish) or not _OF_A_LIMIT.search(line.wish):
        return None
    freed = numbers_of(line.users, context.user_names)
    names = ("weights",) if _WEIGHTS.search(line.wish) else ("max_rate_bps", "min_rate_bps")
    if names[0] != "weights" and not _CAPS.search(line.wish):
        names = ("min_rate_bps", "max_rate_bps")
    for name in names:
        held = context.constraints.get(name)
        own = None if held is None or isinstance(held, tuple) else _by_user(held, context.user_names)
        if own is None or held is None or not freed & numbers_of(tuple(own), context.user_names):
            continue
        theirs = {user: figure for user, figure in own.items() if freed & numbers_of((user,), context.user_names)}
        if line.figures and {figure.value for figure in line.figures} != set(theirs.values()):
            asked, stays = line.figures[0].text, line.voice.constraints({name: theirs})
            return line.ask("not_promised", text=asked, users=line.voice.users(line.users), constraints=stays)
        rest = {user: figure for user, figure in own.items() if user not in theirs}
        if line.figures and isinstance(held, Mapping) and EVERYBODY in held:
            common = _of_everybody(held, theirs, freed, context.user_names)
            if common is not None:
                return line.allocate(str(context.objective), {name: common}, amends=True, dropped=(name,))
        values: dict[str, Constraint] = {name: rest} if rest else {}
        gone: dict[str, Constraint] = {name: {user: figure for user, figure in own.items() if user not in rest}}
        return line.allocate(str(context.objective), values, amends=True, dropped=(name,), taken_off=gone)
    return line.ask("no_limit_of_its_own", users=line.voice.users(line.users))


def _of_everybody(
    held: Mapping[str, float], theirs: Mapping[str, float], freed: set[int | str], user_names: Sequence[str]
) -> Mapping[str, float] | None:
    """What is left where the own figures of some go and everybody's holds for them too; None where they have none."""
    left = {user: figure for user, figure in held.items() if not freed & numbers_of((user,), user_names)}
    return left if len(left) < len(held) and held[EVERYBODY] not in theirs.values() else None


def _by_user(held: float | Mapping[str, float], user_names: Sequence[str]) -> dict[str, float]:
    """Figures by user with everybody written out."""
    figures: dict[str, float] = {**held} if isinstance(held, Mapping) else {EVERYBODY: held}
    for_all = figures.pop(EVERYBODY, None)
    if for_all is None:
        return figures
    named = numbers_of(tuple(figures), user_names)
    rest = [place for place in range(1, len(user_names) + 1) if place not in named]
    return {**figures, **{_reference(user_names[place - 1], place): for_all for place in rest}}


def _reference(name: str, place: int) -> str:
    return str(place) if name.lower() == f"user {place}" else name


def _taken_in(line: Line) -> Intent | None:
    """ "Also serve user 2": a user more, where only some are served."""
    context = line.context
    if _EVERYONE_IN.fullmatch(line.wish):
        back = tuple(name for name in LISTS_OF_USERS if name in context.constraints)
        if not back:
            return line.ask("all_served")
        return line.allocate(str(context.objective), {}, amends=True, dropped=back)
    if not line.users or line.figures or not (_TAKEN_IN.fullmatch(line.wish) or _KEPT_IN.fullmatch(line.wish)):
        return None
    values, dropped = taken_in(line.users, context)
    if not values and not dropped:
        return line.ask("served_already", users=line.voice.users(line.users))
    return line.allocate(str(context.objective), values, amends=True, dropped=dropped)


def _same_for(line: Line) -> Intent | None:
    """ "User 3 too": what was stated last of a user holds for another one as well."""
    if not line.users or line.figures or not _SAME_FOR.fullmatch(line.wish):
        return None
    values: dict[str, Constraint] = {}
    for name, value in line.context.stated.items():
        if name in LISTS_OF_USERS and isinstance(value, tuple):
            held = line.context.constraints.get(name, value)
            values[name] = tuple(dict.fromkeys((*(held if isinstance(held, tuple) else ()), *line.users)))
        elif isinstance(value, Mapping) and len(set(value.values())) == 1:
            values[name] = dict.fromkeys(line.users, next(iter(value.values())))
    return line.allocate(str(line.context.objective), values, amends=True) if values else None
