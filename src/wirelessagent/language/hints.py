"""Words that hint at what a figure or a user is there for, in five languages; the model of roles weighs them.

They are beginnings of words. None decides anything: "no more", "limit" or "without" say much beside one figure and
nothing beside the next. They let the model read words that it never met in a sentence with a known meaning.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence

from wirelessagent.language.deferred import deferred

_BEGINNINGS: Mapping[str, str] = {
    "capped": (
        "cap caps capped capping ceiling limit thrott clamp hold held restrict more over above beyond exceed "
        "upper most best max enough stop up top slow tope techo límit máx pase pasa supere rebas excede sin mucho "
        "hasta frena plafon limit brid born dépass excéd jusqu plus bloqu tenu deckel gedeckel drossel gedrossel "
        "begrenz kapp gekapp abrieg abgerieg höchst obergrenz maximal mehr über brems gebrems drüber schluss"
    ),
    "floored": (
        "min guarant assur promis floor least less below under need must require deserv better garant asegur mín "
        "menos baje debajo necesit piso suelo prometid moins planch promis sous besoin mindest wenigst zugesich "
        "versproch unter weniger brauch untergrenz reicht reichen"
    ),
    "exact": ("exact precise neither fixed pinned clavad justo ni pile rond précis genau exakt"),
    "now": (
        "now current present yesterday was were had used measur moment stuck complain earlier before still ahora "
        "ayer antes eran era fue fueron tenía actual maintenant hier était avait actuel moment aktuell derzeit "
        "gestern war waren hatte bisher momentan jetzt laut"
    ),
    "drawn": (
        "circuit electronic hardware cabinet board static idle baseband stand quiescent consum draw eat burn "
        "vanish gear box fan cool fixed rack overhead gabinete cabina armario electrónic estátic repos fij equipo "
        "gasto chup armoire baie électroni fixe statique vide dissip schrank elektronik schaltung technik grund "
        "ruhe statisch basisband schluck friss frisst zieht eigen verbrauch keller anlage"
    ),
    "sent": (
        "transmi emit emis radiat antenn air tx amplifier rf salida aire radiad émis émet rayonn sortie l'air "
        "send sende luft strahl abstrahl funk verstärker output"
    ),
    "out": (
        "leav left skip exclud drop omit ignor forget without except spare off away absent gone nothing no not "
        "cancel suspend cut barred park wait zero none moved quit out kick fuera exclu olvid olvíd salt sin menos "
        "salvo ignor prescin desatend nada apagad esper baja quit quít aguant cero ningun deja paz tampoco sans "
        "sauf hors oubl écart écarte côté absent coup rien aucun débranch étein ray supprim passe abstraction "
        "attend pas plus priv ohne außer ausgenommen ausschl übersprin überspring streich weg raus nichts abklemm "
        "abhäng entfäll gesperrt leer nicht verzicht abgemeld pausier warten gestohlen klammer ausklam kein"
    ),
    "alone": (
        "only alone just sole exclusiv else apart solo sólo únic solament nadie seul uniqu rien personne autre "
        "nur allein ausschließ einzig sonst remain"
    ),
    "weighed": (
        "weigh count priorit import twice double triple peso pesa cuent cont val doble poids pès pes compt pond "
        "vaut gewicht zähl wichtig"
    ),
}
_CHINESE: Mapping[str, str] = {
    "capped": "封 限 顶 卡 压 超 不过 别过 以内 以下 至多 最多 最高 上限 到头 为止 高于 只准 只许",
    "floored": "至少 最少 最低 保 低于 少于 下限 起码 承诺 底 要",
    "exact": "恰好 正好 刚好 锁 固定 不多不少",
    "now": "现在 目前 昨 原先 才 之前 曾 上次 当前 以前 原来 现有",
    "drawn": "电路 電路 静态 固定 设备 机柜 自身 待机 本身 空载 耗 基带 风扇 空调 开销",
    "sent": "发射 發射 天线 辐射 功放 输出",
    "out": "不 别 除 去掉 排除 停 踢 剔 撇 略 晾 免 离线 缺席 关机 欠费 掉线 下线 撤 放弃 屏蔽 断 没",
    "alone": "只 仅 单 唯 就 专",
    "weighed": "权 算 顶 份 倍 重",
}
_MARKS = deferred(r"['’\-(\[\"“«/]")
HINTS: Mapping[str, Sequence[str]] = {
    "power": ("drawn", "sent", "now", "capped"),
    "rate": ("capped", "floored", "exact", "now"),
    "user": ("out", "alone", "weighed", "now"),
    "number": ("capped", "floored", "drawn", "sent", "weighed", "out", "now"),
}


def hints(names: Sequence[str], before: str, after: str) -> list[str]:
    """Which hints stand before and after something within its clause.

    >>> hints(("capped", "floored"), "held to ", " by contract")
    ['capped ahead']
    """
    patterns = _patterns()
    sides = [(side, _spaced(words)) for side, words in (("ahead", before), ("behind", after)) if words]
    return [f"{name} {side}" for name in names for side, words in sides if patterns[name].search(words) is not None]


def _spaced(words: str) -> str:
    """Lower case with a space before every word, so that the patterns need not look for borders."""
    return " " + _MARKS.sub(" ", words.lower())


@functools.cache
def _patterns() -> Mapping[str, re.Pattern[str]]:
    return {
        name: deferred(f" (?:{'|'.join(words.split())})|{'|'.join(_CHINESE[name].split())}")
        for name, words in _BEGINNINGS.items()
    }
