"""What the terms mean that decisions are told in, in English and Chinese; objectives tell of themselves."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from wirelessagent import plugins
from wirelessagent.model.objective import Objective


@dataclass(frozen=True, kw_only=True)
class Entry:
    """A term: what people call it, and what it means, in either language."""

    names: tuple[str, ...]
    en: str
    zh: str

    def told(self, language: str) -> str:
        return self.zh if language == "zh" else self.en


def explained(text: str, language: str) -> str:
    """What the terms in a text mean, in the order they are named, two at most; empty where none is known.

    A longer term wins over one within it: "price of power" is not power.
    """
    said = _plain(text)
    found: list[tuple[int, int, str]] = []
    for entry in (*ENTRIES, *objectives()):
        places = [(at, at + len(name)) for name in entry.names for at in _places(said, _plain(name))]
        if places:
            first, last = max(places, key=lambda place: place[1] - place[0])
            found.append((first, last, entry.told(language)))
    outer = [one for one in found if not any(_within(one, other) for other in found)]
    return "\n".join(dict.fromkeys(told for _, _, told in sorted(outer)[:2]))


def objectives() -> list[Entry]:
    """The entries of all registered objectives, plug-ins too: their names, their phrases and their own summary."""
    found: list[Entry] = []
    for one in plugins.plugins("objective"):
        if one.cls is None or not issubclass(one.cls, Objective):
            continue
        cls = one.cls
        phrases = tuple(phrase for said in (*cls.phrases.values(), *cls.figure_name.values()) for phrase in said)
        names = (cls.name, cls.name.replace("_", " "), *cls.aliases, *_ALSO.get(cls.name, ()), *phrases)
        chinese = _CHINESE_SUMMARIES.get(cls.name, one.summary)
        spoken = next(iter(cls.phrases.get("zh", ())), cls.name)
        unit_en, unit_zh = (f" Unit: {cls.unit}.", f"单位：{cls.unit}。") if cls.unit else ("", "")
        found.append(Entry(names=names, en=f"{cls.name}: {one.summary}{unit_en}", zh=f"{spoken}：{chinese}{unit_zh}"))
    return found


def _within(one: tuple[int, int, str], other: tuple[int, int, str]) -> bool:
    return other[0] <= one[0] and one[1] <= other[1] and other[1] - other[0] > one[1] - one[0]


def _plain(text: str) -> str:
    """Without case, accents of width, hyphens and underscores."""
    return re.sub(r"[\s_\-–]+", " ", unicodedata.normalize("NFKC", text).casefold()).strip()


def _places(said: str, name: str) -> list[int]:
    """Where a name stands as a word of its own, or as Chinese characters; a plural is the same word."""
    edge = r"(?<![a-z0-9]){}(?:s|es)?(?![a-z0-9])" if name.isascii() else "{}"
    return [match.start() for match in re.finditer(edge.format(re.escape(name)), said)]


_ALSO = {
    "max_rate": ("sum rate", "total rate", "总速率", "和速率"),
    "min_power": ("least power", "minimum power", "最小功率", "功率最低"),
    "max_energy_efficiency": ("ee", "energy efficient", "bits per joule", "bit/j", "能效"),
    "proportional_fairness": ("pf", "proportionally fair", "proportional fair", "比例公平"),
    "max_min_rate": ("max min", "max min fairness", "maxmin", "min rate fairness", "最大最小"),
}
"""What else built-in objectives are called when they are asked about."""

_CHINESE_SUMMARIES = {
    "max_rate": "所有用户速率之和最大，Σ r；强用户得到大部分，弱用户可能什么都得不到。",
    "min_power": "在满足每个承诺速率的前提下发射功率最小，Σ p。",
    "max_energy_efficiency": "每消耗一焦耳传送的比特最多，Σ r / (Σ p/ξ + P_c)，其中 P_c 为电路功率。",
    "proportional_fairness": "各用户速率的乘积最大，Σ ln r；任何人提高一定百分比，其他人合计都会降低更多百分比。",
    "max_min_rate": "让最低的速率尽可能高，min r；有权重时按权重的比例。",
}

ENTRIES: tuple[Entry, ...] = (
    Entry(
        names=("subcarrier", "resource block", "RB", "PRB", "resource block group", "RBG", "子载波", "资源块"),
        en="A subcarrier (or resource block) is a narrow slice of the band. In one slot it serves one user; its "
        "rate is B log2(1 + p g / (Γ N0 B)) for the power p on it and the user's gain g there.",
        zh="子载波（或资源块）是频带中的一小段，每个时隙只服务一个用户；功率为 p、该用户增益为 g 时，速率为 B "
        "log2(1 + p g / (Γ N0 B))。",
    ),
    Entry(
        names=(
            "certificate", "certified", "bound", "gap", "optimal", "optimality", "duality gap", "dual bound", "proof",
            "证书", "证明", "上界", "下界", "差距", "最优", "对偶间隙",
        ),
        en="The bound is a value that no allocation can beat, proven from prices by Lagrangian duality, whatever "
        "was searched. The gap is how far the decision is from it, as a share of it: at most that much could be "
        "gained. Gap 0 means optimal. Both hold for the channel as it was estimated.",
        zh="界是任何分配都无法超过的数值，由拉格朗日对偶从价格证明，与搜索过程无关。差距是本方案与界相差的比例：最"
        "多还能改进这么多；差距为 0 即最优。两者都针对估计信道。",
    ),
    Entry(
        names=("outage", "outage probability", "reliability", "中断", "中断概率", "可靠性"),
        en="The outage probability is how often a promised rate may fail because the channel is not exactly known: "
        "5 % means that a promise is kept with a probability of 95 %. A smaller one costs power or rate.",
        zh="中断概率是由于信道不确定，承诺速率可以落空的概率：5 % 表示承诺以 95 % 的概率兑现。概率越小，代价（功率"
        "或速率）越高。",
    ),
    Entry(
        names=(
            "kriging", "repair", "repaired gain", "missing gain", "interpolation", "imputation", "克里金", "修复",
            "缺失", "插值",
        ),
        en="Repair fills gains that were not measured. Kriging is the best linear estimate from the gains measured "
        "nearby, weighted by how strongly gains hang together over frequency and between users; it also says "
        "how sure it is, as a 90 % band for every gain.",
        zh="修复用于填补未测得的增益。克里金是由邻近测得增益作出的最佳线性估计，权重取决于增益在频率和用户之间的相"
        "关性；它同时给出把握，即每个增益的 90 % 区间。",
    ),
    Entry(
        names=("goodput", "有效吞吐量", "有效吞吐"),
        en="Goodput is what arrives: the committed rates that the true channel carries. A user is sent at a rate "
        "chosen beforehand; if the channel carries less, all of it is lost.",
        zh="有效吞吐量是真正到达的部分：真实信道能承载的预定速率之和。用户的发送速率事先选定，信道承载不了就全部丢"
        "失。",
    ),
    Entry(
        names=("water filling", "waterfilling", "water level", "注水", "注水法", "水位"),
        en="Water-filling shares power among subcarriers: each gets the power that fills it up to one level, λ − "
        "1/a for the SNR per watt a, and those above the level get none. Past that level a watt is worth more "
        "elsewhere.",
        zh="注水法在子载波之间分配功率：每个子载波注到同一水位，即 λ − 1/a（a 为每瓦信噪比），高于水位的不分配；超"
        "过水位，多一瓦用在别处更值。",
    ),
    Entry(
        names=("dbm", "dbw", "decibel", "db", "分贝", "毫瓦分贝"),
        en="dB is ten times the logarithm of a ratio: 3 dB is a factor of 2, 10 dB one of 10. dBm is a power over "
        "1 mW: 30 dBm is 1 W, 40 dBm is 10 W, 43 dBm is 20 W. dBW is one over 1 W.",
        zh="dB 是比值对数的十倍：3 dB 为 2 倍，10 dB 为 10 倍。dBm 是相对 1 mW 的功率：30 dBm 为 1 W，40 dBm 为 10 "
        "W，43 dBm 为 20 W；dBW 相对 1 W。",
    ),
    Entry(
        names=(
            "price of power", "power price", "marginal price", "shadow price", "price", "lagrange multiplier",
            "功率价格", "功率的价格", "边际价格", "影子价格", "价格",
        ),
        en="The price of power is what one more watt would add to the best value at the margin: the slope of the "
        "bound in the power budget; 0 where the budget is not used up. A promised rate has a price too: what "
        "one more bit/s for that user costs. Large steps differ from it, so they are solved anew when you ask "
        "for one.",
        zh="功率的价格是边际上多一瓦能使最优值增加多少，即界对功率预算的斜率；预算未用完时为 0。承诺速率也有价格："
        "向该用户多承诺1 bit/s 的代价。较大的变化与之不同，因此提问时会重新求解。",
    ),
    Entry(
        names=(
            "gain", "channel gain", "csi", "channel state information", "channel", "增益", "信道增益", "信道状态信息",
            "信道",
        ),
        en="The gain is the share of the radiated power that reaches a user on a subcarrier. Together the gains "
        "are the channel state information (CSI); they change from slot to slot, and some are not measured.",
        zh="增益是某子载波上发射功率到达用户的比例。所有增益合称信道状态信息（CSI），逐时隙变化，其中一些没有测得。",
    ),
    Entry(
        names=("snr", "signal to noise ratio", "sinr", "信噪比"),
        en="The SNR is the received power over the noise, p g / (N0 B). Each doubling (3 dB) of a high one adds "
        "about 1 bit/s/Hz.",
        zh="信噪比是接收功率与噪声之比，p g / (N0 B)。信噪比较高时每加倍（3 dB）约增加 1 bit/s/Hz。",
    ),
    Entry(
        names=(
            "minimum rate", "promised rate", "rmin", "qos", "min rate", "guaranteed rate", "最低速率", "承诺速率",
            "保证速率", "服务质量",
        ),
        en="A minimum (promised) rate must be kept for a user before anything else is optimised. If the power does "
        "not carry all of them, the request is infeasible, and nothing is applied.",
        zh="最低（承诺）速率须先满足，再优化其他。若功率无法承载全部承诺，该要求不可行，不会应用任何内容。",
    ),
    Entry(
        names=("infeasible", "feasible", "undecided", "infeasibility", "不可行", "可行", "未定"),
        en="Infeasible: proven that no allocation keeps every limit. Feasible: one was found, with a known gap to "
        "the best. Undecided: none was found, and none is proven impossible.",
        zh="不可行：已证明没有分配能满足所有限制。可行：已找到一个，且与最优的差距已知。未定：没有找到，也没有证明"
        "不存在。",
    ),
    Entry(
        names=("weight", "weights", "priority", "priorities", "权重", "优先级"),
        en="A weight says how much a user's rate counts: with weight 2 each bit/s counts twice. Where the lowest "
        "rate counts, weights are shares: weight 2 gets twice the rate.",
        zh="权重表示用户速率的重要程度：权重 2 表示每 bit/s 计两倍。在最低速率最大的目标下权重是份额：权重 2 得到两"
        "倍速率。",
    ),
    Entry(
        names=("circuit power", "pc", "电路功率"),
        en="Circuit power is drawn whatever is radiated, P_c. It makes very low power inefficient: energy "
        "efficiency is the rate over the radiated power (over the amplifier's efficiency) plus P_c.",
        zh="电路功率 P_c 与发射多少无关。它使功率过低时效率也低：能效等于速率除以（发射功率/放大器效率 + P_c）。",
    ),
    Entry(
        names=(
            "pmax", "power budget", "maximum power", "max power", "transmit power", "功率预算", "最大功率",
            "功率上限",
        ),
        en="Pmax is the power budget: the most that all subcarriers together may radiate. It can be lower than the "
        "cell's own limit, never higher.",
        zh="Pmax 是功率预算：所有子载波合计的最大发射功率，可低于小区自身上限，不能更高。",
    ),
    Entry(
        names=("jain", "jain index", "fairness index", "fairness", "公平指数", "公平性", "公平"),
        en="Jain's fairness index is (Σ r)² / (K Σ r²) for K users: 1 when all rates are the same, 1/K when one "
        "user has everything.",
        zh="Jain 公平指数为 (Σ r)² / (K Σ r²)：速率全相同时为 1，一个用户独占时为 1/K。",
    ),
    Entry(
        names=("spectral efficiency", "频谱效率", "频谱利用率"),
        en="Spectral efficiency is the rate per hertz of bandwidth, in bit/s/Hz.",
        zh="频谱效率是每赫兹带宽的速率，单位 bit/s/Hz。",
    ),
    Entry(
        names=("ofdma", "ofdm", "正交频分多址"),
        en="OFDMA divides the band into subcarriers that do not disturb each other, and gives each to one user per "
        "slot.",
        zh="OFDMA 把频带分成互不干扰的子载波，每个时隙把每个子载波分给一个用户。",
    ),
)  # fmt: skip
"""Terms beside the objectives."""
