"""The words around a figure or a user that say what it means, as patterns: circuits, corrections, totals, changes."""

from __future__ import annotations

from wirelessagent.language.deferred import deferred
from wirelessagent.language.number_words import cardinals
from wirelessagent.language.phrases import Phrases

HUGE_POWER_W = 1e5  # no cell radiates this much: a megawatt is a misspelt milliwatt

CIRCUIT = deferred(
    r"(?ia)\b(?:circuits?|circuitry|static|fixed|idle|overhead|baseline(?= (?:power|consumption|draw|load|"
    r"energy))|stand-?by|quiescent|electronics|hardware|"
    r"cooling|constant)\b"
    r"(?:\s+(?:power|energy|consumption|draw|load)\b)*|(?<![A-Za-z])p[_ ]?c(?:ircuit)?(?![A-Za-z])|\b(?:fij[oa]s?|"
    r"circuitos?|(?<!on )(?<!je )fixe(?!\s+(?:à|un|une|le|la|[0-9]))|statique|schaltung\w*|"
    r"fest\w{0,2}|grundlast|grundverbrauch|ruheverbrauch|elektronik)\b|(?:\b(?:cabinet|rack|baseband|bbu|boards?|"
    r"equipment|shelter|fans?|rectifier)\b)|\b(?:regardless of (?:the )?(?:traffic|load)|no matter the load|"
    r"even (?:when |while )?idle|by itself|on its own|at zero load|without any traffic)\b|(?:机柜|基带|主设备|空载|"
    r"风扇|电路|静态|固定|基础|设备自身|待机|硬件|板子|整机|器件|本底)"
    r"(?:功率|功耗|能耗|消耗|耗电|损耗)?"
)
RADIATED = deferred(
    r"(?i)\b(?:transmit|transmission|transmitted|tx|radiated|output|p_?max|sendeleistung|strahl\w*|"
    r"puissance d'émission|"
    r"potencia (?:de transmisión|radiada))\b|发射|辐射"
)
CORRECTION = deferred(
    r"(?ia)\b(?:no|nope|wait|sorry|i mean|i meant|make (?:that|it)|scratch that|rather|correction|oops|actually|"
    r"better|pardon|er|"
    r"non|nein|perdón|pardon|mejor|plutôt|lieber|besser|doch|digo|ich meine|je veux dire|quiero decir|strike that|"
    r"let's say)\b|"
    r"[,\uff0c。]\s*不\s*[,\uff0c]|不对|不是|应该是|改成|改为|算了|错了|说错|还是|哦不|不不|口误|更正|纠正"
)
NEGATED = deferred(  # "more than 10 W are not to be had", 超过4瓦不行
    r"(?i)\b(?:not|no|never|nicht|ned|nie|kein\w*|nunca|sin|pas|jamais|garde-toi|évite|vermeide|avoid|gibt's aber)\b|"
    r"[别不勿禁]|报警|跳闸"
)
EXACT = deferred(
    r"(?i)(?:\s+(?:each|apiece|per user|por usuario|par personne|chacun|cada uno|pro nutzer))?\s*,?\s*(?:exactly|exact|"
    r"precisely|no more,? no less|exact[oa]s?|clavad[oa]s?|ni más ni menos|exactement|pile|tout rond|"
    r"ni plus ni moins|genau|exakt)\b"
)
EXACT_BEFORE = deferred(
    r"(?i)\b(?:exactly|precisely|exactamente|exactement|précisément|genau|exakt)\s+$|(?:锁定?在?|锁死在|恰好|正好|刚好)\s*$"
)
PER_USER = deferred(
    r"(?i)\s*(?:each\b|apiece\b|(?:per|a|for (?:each|every))\s+(?:user|ue|person|head|subscriber|device|sensor|"
    r"subcarrier|channel|carrier|antenna|tone)|/\s*(?:user|ue)|每|(?:por|par|pro|je)\s+(?:usuario|utilisateur|"
    r"nutzer))"
)
TOTAL_BEFORE = deferred(r"(?:总速率|总吞吐量?|和速率|总共|合计|一共)[\w\s:=]{0,8}$")
TOTAL_AFTER = deferred(
    r"(?i)\s*(?:of\s+)?(?:in\s+total|total|altogether|overall|combined|in\s+sum|"
    r"(?:to\s+be\s+)?(?:split|shared|divided|distributed))\b"
)
CHANGE_BEFORE = deferred(
    r"(?i)(?:\b(?:by|save|saves|saving|cut|another|extra|additional|reduce|(?<!au )plus|increase)\s*(?:about|"
    r"around|roughly)?|"
    r"(?:减少|降低|节省|省下?|增加|提高|再加|(?<![最至])多给|下降|提升|升高|(?<=[功速]率)[降减升增加])了?)\s*$"
)
CHANGE_AFTER = deferred(r"(?i)\s*(?:(?:of\s+)?(?:more|less|lower|higher|faster|extra)\b)")
SET_TO = deferred(
    r"(?i)(?:\b(?:reduce|lower|cut|drop|bring|decrease|turn|raise|increase|set|limit)\s+(?:down\s+|up\s+)?(?:the\s+)?"
    r"(?:total\s+|max\w*\s+)?(?:transmit\s+|tx\s+|radiated\s+)?(?:power|budget)(?:\s+budget)?\s+(?:down\s+|"
    r"up\s+)?(?:to|at)|"
    r"(?:总?发?射?功率)(?:降低?|减[小少]?|调|提高|升|增加?|设)(?:到|至|为)|(?:降低?|减[小少]?|"
    r"提高)(?:总?发?射?功率)(?:到|至))\s*$"
)
RATE_SET_TO = deferred(
    r"(?i)\b(?:raise|increase|bring|set|lift|boost|push|lower|reduce)\s+(?:the\s+|each\s+|every\s+|their\s+)*"
    r"(?:min\w*\s+|user\w*\s+|data\s+|bit\s+)*(?:rates?|speeds?|throughput)\s+(?:up\s+|down\s+)?to\s+$"
)
MISSING = deferred(
    r"(?ia)\b(?:missing|lost|loss|unknown|holes?|absent|gone|faltar\w*|falta\w*|perd\w*|manqu\w*|fehl\w*|"
    r"verloren)\b|缺失|丢失|缺少|丢包|未知|缺|丢"
)
_COUNT = rf"(?:[0-9]+|{'|'.join(cardinals(2, 10))})"
COUNTED_USERS = deferred(
    rf"(?i)(?<![\w.,/^*-]){_COUNT} (?:of them|of the users|"
    r"users|ues|subscribers|devices|sensors|terminals|subcarriers|channels|usuarios|"
    r"abonados|clientes|utilisateurs|abonnés|nutzern?|teilnehmern?|kunden)\b|[0-9两二三四五六七八九十]+\s*个(?:用户|"
    r"设备|传感器|子载波)"
)
SOME_USERS = Phrases(
    r"\b(?:one|most|some|a few|several|many|certain|part)\s+(?:of\s+)?(?:the\s+|our\s+)?(?:users?|ues?)\b|"
    r"(?:部分|一些|某些|某个)用户|"
    r"\b(?:odd|even)(?:[- ]numbered)?\s+users?\b|"
    r"\b(?:except|but|without)\s+(?:for\s+)?the\s+(?:last|first)(?:\s+(?:one|two|three|few|user|users))?(?=\s*(?:$|[,.;:!]))|"
    r"\b(?:leav\w+|drop\w*|exclud\w+|kick\w*|cut)\s+(?:out\s+)?(?:the\s+)?users\s+(?:out\s+)?(?:who|that|which|with|whose)\b|"
    r"\busers?\s+[0-9]+\s+(?:and|or)\s+(?:up|above|higher|beyond|onwards?|more)\b|"
    r"\b(?:users?|ues?)\s+[-−][0-9]+|用户\s*[-−][0-9]+|"
    r"(?:单|双|奇数|偶数)号?(?:的)?用户|(?:一半|半数)的?用户|[0-9]号(?:及|和)?(?:以后|以上|往后)|"
    r"[^,\uff0c。0-9]{1,8}的用户都?(?:踢|去掉|不服务|排除|剔除)"
)
NOBODY = Phrases(
    r"\bserv(?:e|ing) (?:(?:nobody|no one)(?!\s+(?:else|but|except|apart|other))|"
    r"none of (?:them|the users)|no users?(?! (?:below|under|above|with)))\b|"
    r"\bleav(?:e|ing) (?:everyone|everybody|all users|all of them) out\b|"
    r"(?:所有|全部|全体)(?:用户|人|终端)(?:一个)?(?:都|全)?不(?:服务|带|管)|(?:一个|谁)(?:用户)?都不(?:服务|带|管)",
    marks="serv leav 所有 全部 全体 一个 谁",
)
_OF_OURS = r"(?:\w+\s+){0,3}?(?:power|watts?|wattage|rates?|speeds?|throughput|bandwidth|budget|limit)\b"
HALVED = Phrases(
    r"\bby (?:a )?(?:half|third|quarter)\b|"
    rf"\b(?:half (?:the|of the|as much)|halve)\s+{_OF_OURS}|"
    r"(?:功率|速率|速度|网速|预算)[^,，。;]{0,3}(?:减半|一半|翻倍)|(?:减半|一半|翻倍)的?(?:功率|速率|速度|网速|预算)",
    marks="half halve third quarter 减半 一半 翻倍",
)
EITHER = deferred(  # between two figures
    r"(?i)\s*,?\s*(?:or|o|ou|oder|或者?|还是|(?:or\s+)?(?:if\s+possible|ideally|preferably),?\s+(?:else|otherwise|or)|else|otherwise)\s*"
)
OTHERS_HALVED = Phrases(
    r"(?:其余|其他|别人|剩下|剩余|旁人|另外)[^,\uff0c。0-9]{0,5}(?:一半|减半|翻倍|双倍|加倍)",
    marks="一半 减半 翻倍 双倍 加倍",
)
_POWER = (
    r"(?:power|budget|watts|wattage|potencia|presupuesto|puissance|leistung|sendeleistung)\b(?:\s+(?:budget|limit))?"
)
_FULL = (
    r"(?:\s+|of|de|d'|the|our|its|full|max|maximum|total|available|allowed|transmit|tx|la|el|del|notre|nuestra|der|die|"
    r"unserer|vollen|maximalen)*"
)
SHARE = Phrases(
    r"(?<!save )(?<!by )(?<!saving )(?<!cut )(?:(?P<half>\bhalf\b|\b(?:la )?mitad\b|\b(?:la )?moitié\b|"
    r"\bhalbe[rn]?\b|\bhälfte\b)|(?P<thirds>\b(?:two thirds|dos tercios|deux tiers|zwei dritteln?)\b)|"
    r"(?P<third>\b(?:(?:a|one|un|ein(?:em)?) )?(?:third|tercio|tiers|drittel)\b)|"
    r"(?P<quarters>\b(?:three quarters|tres cuartos|trois quarts|drei vierteln?|dreiviertel)\b)|"
    r"(?P<quarter>\b(?:(?:a|one|un|ein(?:em)?) )?(?:quarter|cuarto|quart|viertel)\b)|"
    r"(?<![\w.,])(?P<percent>[0-9]{1,3}(?:\.[0-9]+)?)\s*(?:%|percent|per cent|prozent|por ciento|pour cent))"
    rf"{_FULL}\s*{_POWER}"
    r"|(?:用|以|只用|最多用|不超过)?(?:(?P<zh_half>一半)|(?<![0-9.])(?P<zh_percent>[0-9]{1,3}(?:\.[0-9]+)?)%|"
    r"百分之(?P<zh_word>[0-9]{1,3})|(?P<zh_third>三分之一)|(?P<zh_thirds>三分之二)|(?P<zh_quarter>四分之一)|"
    r"(?P<zh_tenths>[一二三四五六七八九])成)的?(?:发射|總|总)?(?:功率|预算)(?!放大)"
    r"|(?:功率)(?:只用|最多用|用|不超过|最多|压到|降到)?(?:到)?(?:(?P<of_half>一半)|(?P<of_tenths>[一二三四五六七八九])成)(?!五)",
    marks="half mitad moitié halbe hälfte third tercio tiers drittel quart cuarto viertel % percent per_cent prozent "
    "por_ciento pour_cent 一半 百分之 分之 成",
)
TENTHS = {letter: place / 10 for place, letter in enumerate("一二三四五六七八九", start=1)}
SHARES = {
    "half": 1 / 2, "zh_half": 1 / 2, "of_half": 1 / 2, "third": 1 / 3, "zh_third": 1 / 3, "thirds": 2 / 3,
    "zh_thirds": 2 / 3, "quarter": 1 / 4, "zh_quarter": 1 / 4, "quarters": 3 / 4,
}  # fmt: skip
_CARRIER = (
    r"(?:sub-?carriers?|tones?|carriers?|rbs?|resource blocks?|subportadoras?|sous-porteuses?|(?:unter|sub)träger[ns]?)"
)
_ONE = (
    r"(?:each|every|any|no|an?|one|the|single|individual|cada|una|ninguna|sola|chaque|une|aucune|seule|jede[mnr]?|"
    r"eine[mnr]?|keine?[mnr]?|einzelne[mnr]?)"
)
SUBCARRIER = deferred(
    r"(?i)\s*(?:of\s+power\s+)?(?:/|(?:per|por|par|pro|je|on|for|in|at|into|over|en|sur|auf)(?!\w)|(?=each|any))"
    rf"[\s-]*(?:{_ONE}\s+)*{_CARRIER}(?!\w)"
)
SUBCARRIER_BEFORE = deferred(
    rf"(?i)(?:(?<!\w)(?:{_ONE}|per|por|par|pro|je)[\s-]+(?:{_ONE}\s+)*{_CARRIER}(?!\w)|"
    r"(?:每个?|单个?|任一|任何|各)子载波)[^,;.，。]{0,40}$"
)
_SIZE = r"[0-9]{1,3}|[a-zäéöûü]{3,8}"
_GROUP = r"(?:groups?|blocks?|bundles?|chunks?|clusters?|packs?|rbgs?|grupos|bloques|groupes?|blocs|paquets|paquetes)"
BLOCKS = Phrases(
    rf"(?:\b{_GROUP}\s+(?:of|de)\s+(?P<of>{_SIZE})\b(?:\s+(?:adjacent\s+|neighbouring\s+)?{_CARRIER}(?!\w))?"
    rf"|\b(?:gruppen|blöcken?)\s+(?:von|zu|à|aus)\s+(?:je\s+)?(?P<zu>{_SIZE})\b"
    rf"|\b(?P<per>{_SIZE})\s+(?:adjacent\s+|neighbouring\s+)?{_CARRIER}\s+(?:per|in (?:a|each|every)|to a|each)\s+"
    r"(?:group|block|bundle|rbg)"
    r"|\b(?:rbg|resource[- ]block[- ]group|block|group)\s?(?:size|大小)\s*(?:of|=|:|is|为|是)?\s*(?P<size>[0-9]{1,3})"
    rf"|{_CARRIER}(?:\s+\w+){{0,3}}\s+(?:in|par)\s+(?P<in>pairs|deux|trois|quatre|six|huit|[0-9]{{1,3}})\b"
    rf"|{_CARRIER}(?:\s+\w+){{0,2}}\s+(?P<by>[a-z]{{3,6}}) by (?P=by)\b"
    r"|\b(?P<fold>zweier|dreier|vierer|fünfer|sechser|achter|zehner|zwölfer)(?:gruppen|blöcken?|päckchen)\b"
    r"|(?:每|按)?(?P<zh>[0-9]{1,3}|[二两三四五六八十]{1,2})个?子载波(?:一组|为一组|一块|为一块|捆绑|绑定|分组|一个组|成组)"
    r"|子载波(?:按|以|每)?(?P<apart>[0-9]{1,3}|[二两三四五六八十]{1,2})个?(?:为|分)?(?:一|成)?[组块](?:来?分(?:配)?)?)",
    marks="group block bundle chunk cluster pack rbg 子载波 grup bloq bloc paq gruppe blöck päck pair carrier porteuse",
)
BLOCK_WORDS = {"pairs": 2, **{f"{word}er": size for word, size in cardinals(2, 12, ("de",)).items()}}
STEP = Phrases(
    r"\b(?:one|an?|another)\s+(?:more\s+)?watt(?:\s+more)?\b|(?:再?多|再加|加)一瓦|"
    r"\bun vatio más\b|\bun watt de plus\b|\bein watt mehr\b",
    marks="watt vatio 一瓦",
)
