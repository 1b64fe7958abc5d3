"""The words of the offline recogniser, English and Chinese, as plain data.

One string of terms per concept, apart by spaces; an underscore joins the words of a phrase, and apostrophes are left
out ("dont").

Longer phrases win over shorter ones, so an exception is a longer phrase of another concept: "dont forget"
is polite, "dont" negates. A concept is what a term does in a sentence; ``goals`` combines them.
"""

from __future__ import annotations

# Terms that mean an objective by themselves; "less_rate" is a wish that no objective serves.
DIRECT: dict[str, str] = {
    "max_rate": (
        "stop_buffering stop_the_buffering no_buffering no_more_buffering without_buffering less_buffering no_lag "
        "less_lag stop_lagging 不要卡 别卡 faster fastest quicker quickest speedy make_it_fast want_it_fast go_fast "
        "be_fast as_fast_as_possible "
        "as_quick_as_possible speed_up  "
        "speeding_up accelerate full_speed full_throttle top_speed high_speed too_slow so_slow very_slow really_slow "
        "is_slow slow sluggish buffering buffers stutters stuttering lagging laggy lags not_fast_enough "
        "isnt_fast_enough more_data really_fast very_fast super_fast fast_network fast_internet fast_wifi "
        "most_data_overall most_data_in_total most_bits_in_total spectral_efficiency spectrum_efficiency "
        "spectrally_efficient rate_maximisation rate_maximization rmax 快 "
        "更快 冲速度 冲速率 冲吞吐 冲网速 拼速度 飙速 "
        " "
        "快一点 快点 快些 快一些 最快 越快越好 要快 加速 提速 高速 高速率 太慢 太卡 很慢 好慢 慢 网速慢 卡顿 很卡 "
        "好卡 "
        " "
        "缓冲 流畅 更流畅 不够快 频谱效率 谱效"
    ),
    "min_power": (
        "radiate_as_little transmit_as_little emit_as_little radiate_little emit_little transmit_little radiate_less "
        "transmit_less emit_less radiate_as_weakly transmit_as_weakly as_little_power 少发射 少辐射 "
        "green greener go_green eco eco_mode low_power low_energy power_saving energy_saving battery_saving "
        "drain_too_fast drains_too_fast draining_too_fast drain_fast drains_fast too_much_power "
        "too_much_energy too_much_electricity economical power_minimisation power_minimization pmin 省电 省点电 节能 "
        "节电 低功耗 省能 绿色 环保 费电 太费电 耗电 耗电太快 耗电太多 功耗太高 功率太大 功耗太大 能耗太高"
    ),
    "max_energy_efficiency": (
        "每瓦 速率功耗比 per_unit_energy per_unit_of_energy energy_efficiency energy_efficient energy_efficiently "
        "power_efficiency "
        "power_efficient ee bits_per_joule  "
        "bit_per_joule bits_joule bit_j bits_j mbit_j kbit_j bits_per_j bit_per_j per_kwh per_kilowatt_hour "
        "per_joule energy_per_bit joules_per_bit joule_per_bit power_per_bit "
        "every_joule each_joule bits_per_watt rate_per_watt per_watt each_watt every_watt 每比特能耗 每焦耳 每焦 "
        "单位能耗传 单位能耗下 单位能耗能传 单位能量 每单位能量 每度电 每一度电 每一焦耳 每一瓦 "
        "能效  "
        "能效比 能量效率 能源效率 高能效 又快又省电 又快又省 又省电又快 既快又省电 既快又省 既省电又快"
    ),
    "less_rate": (
        "slow_down slowing_down slower slowest slowly throttle 放慢 慢一点 慢点 慢一些 降速 限速 最慢 更慢 慢慢 慢下来"
    ),
    "proportional_fairness": (
        "log_rates log_rate log_utility sum_of_logs sum_of_log_rates sum_log_rate sum_of_the_logs "
        "logarithmic_utility "
        "geometric_mean geometric_mean_of_the_rates nash_bargaining 对数和 对数效用 几何平均 "
        "fair fairer fairest fairness equitable equitably proportionally_fair proportional_fair pf 公平 公平性 "
        "更公平 "
        "公平一点 公平一些 公平对待 按比例公平"
    ),
    "max_min_rate": (
        "max_min maxmin max_min_fair equal_rates equal_speeds equally_fast maximise_the_minimum maximize_the_minimum "
        "everyone_at_the_same_speed everyone_at_the_same_rate all_users_at_the_same_speed all_users_at_the_same_rate "
        "最大最小 最大化最小速率 最大化最低速率 最小速率最大 最低速率最大 一样快 同样快"
    ),
    "less_efficiency": "inefficient inefficiently inefficiency 低效 低能效",
}

# Those of the terms above that name what is wrong: more of it is the opposite of the wish, less of it is the wish.
COMPLAINTS = (
    "slow sluggish buffering buffers stutters stuttering lagging laggy lags 慢 卡顿 缓冲 费电 耗电 "
    "energy_per_bit joules_per_bit joule_per_bit power_per_bit 每比特能耗"
)

# Wishes for what is wrong: "as slow as possible".
_FRAMES = (
    "as_{0}_as 尽量{0} 尽可能{0} 越{0}越好 go_{0} be_{0} make_it_{0} make_it_really_{0} make_it_very_{0} keep_it_{0} "
    "make_the_network_{0} make_the_internet_{0} make_everything_{0} make_them_{0} make_the_cell_{0}"
)
_WRONG = {"less_rate": "slow slowly sluggish laggy 慢 卡", "more_power": "power_hungry wasteful 费电 耗电"}
for _objective, _words in _WRONG.items():
    _framed = " ".join(_FRAMES.format(_word) for _word in _words.split())
    DIRECT[_objective] = f"{DIRECT.get(_objective, '')} {_framed}"


# The largest smallest rate, said of the rate: "maximise the lowest throughput".
DIRECT["max_min_rate"] += "".join(
    f" {most}_{the}{least}_{rate}"
    for most in ("maximise", "maximize", "maximising", "maximizing", "max", "highest", "largest", "best")
    for the in ("", "the_", "possible_")
    for least in ("minimum", "min", "lowest", "smallest", "worst")
    for rate in ("rate", "throughput", "speed", "user_rate", "data_rate")
    if (most, the) != ("max", "possible_")
)


# Directions.
UP = (
    "peak is_maximised is_maximized is_maximum is_too_low too_low 拉满 太低 太少 more higher high highest "
    "increase increases increasing increased raise raising boost boosting maximise maximize "
    "maximising maximizing maximises maximizes maximised maximized max maximum maximal most improve improving "
    "improved  "
    "enhance fast quick best greatest better good great greater bigger biggest larger largest lots_of as_much up "
    "push  "
    "crank double extend extending prolong longer not_enough top upgrade 提高 提升 增加 加大 增大 最大化 最大 最高 "
    "更高 更大 更多 高 大 高一点 改善 加快 尽量高 越高越好 越大越好 越多越好 尽可能高 尽可能大 抬 抬高 拉高 "
    "往上拉 补上 补齐 补 不够 延长 更长 更好 多"
)
DOWN = (
    "is_minimised is_minimized too_high is_too_high 太高 太大 drop less fewer fewest as_few lower low lowest "
    "reduce reduces reducing reduced decrease decreasing cut cutting "
    "minimise minimize minimising minimizing minimises minimizes minimised minimized min minimum minimal save saving "
    "saves saved conserve conserving least little as_little smallest smaller economise economize economise_on "
    "economize_on trim lessen spare preserve turn_down down 降低 减少 减小 降 减 最小化 最小 最低 更低 更少 更小 省 "
    "节省 节约 少用 少 低 小 低一点 低一些 小一点 少一点 尽量低 尽量少 越低越好 越少越好 越小越好 尽可能低 尽可能小 "
    "尽可能少 压低"
)
WANT = (
    "help_the help_our helping_the protect protecting want need needs give prioritise prioritize priority "
    "favour favor prefer focus_on its_about it_is_about just "
    "only  "
    "optimise optimize care_about above_all is_everything comes_first all_about matters first important 第一 要 想要 "
    "需要 优先 只要 只管 关注 优化 重要 保障"
)
KEEP = (
    "without_losing without_hurting without_sacrificing without_compromising without_reducing without_lowering "
    "without_killing without_harming 不影响 不牺牲 不损失 不降低"
)
WASTE = (
    "waste wasting wasted wastes wasteful squander squandering burn burning burns drain draining drains drained 浪费 "
    "耗尽"
)
BAD = (
    "worst worse worsen worsening bad poor poorer poorest terrible awful degrade degrading degraded hurt harm ruin "
    "kill destroy sabotage neglect sacrifice sacrificing compromise_on 最差 更差 变差 恶化 牺牲 破坏"
)

# What a direction applies to.
RATE = (
    "rate rates speed speeds throughput thruput capacity bandwidth bitrate bit_rate data_rate data_rates download "
    "downloads downloading upload uploads uploading sum_rate goodput connection connections 速率 速度 网速 吞吐量 "
    "吞吐  "
    "容量 带宽 下载 上传 下载速度 上传速度 总速率 和速率 码率 数据率 数据速率 传输速率"
)
STREAM = (
    "video videos streaming stream streams gaming video_quality video_streaming video_stream video_streams 视频 "
    "视频流  "
    "直播 游戏 画质 视频质量"
)
PERFORMANCE = "performance quality qos 性能 质量 体验"
POWER = (
    "power energy consumption power_consumption energy_consumption electricity transmit_power transmission_power "
    "radiated_power tx_power "
    "battery_drain battery_usage battery_consumption power_drain energy_drain "
    "watt watts wattage emissions power_usage energy_usage energy_use power_use power_draw "
    "功率 功耗 能耗 电 电量 电力 耗电量 发射功率 能量 能源 电费 总功率 能源消耗 能量消耗 用电"
)
BATTERY = "battery batteries battery_life battery_lifetime 电池 续航 电池寿命 电池续航"
WORST = (
    "unluckiest least_fortunate 谁最慢 谁最差 谁最弱 谁垫底 短板 短版 "
    "whoever_is_slowest whoever_is_worst_off whoevers_slowest "
    "最小用户速率 最低用户速率 最小用户的速率 最低用户的速率 最差那个用户 最慢那个用户 最差的那个用户 最慢的那个用户 "
    "最弱的那个用户 最慢的那个人 最差的那个人 最慢用户 最慢的用户 最慢的人 最差用户 最差的用户 最弱用户 最弱的用户 "
    + " ".join(
        f"{worst}_{user}{plural}"
        for worst in ("slowest", "weakest", "worst", "poorest", "worst_off", "worst_served", "most_disadvantaged")
        for user in ("user", "ue", "subscriber", "device", "terminal", "customer")
        for plural in ("", "s")
    )
)
EFFICIENCY = "efficiency efficient efficiently 效率 高效"

# How a sentence is built.
NOT = (
    "disable disabling turn_off turning_off switch_off deactivate exit leave quit abandon neither "
    "more_important_than matters_more_than more_than 关闭 关掉 退出 停用 禁用 比 not no dont do_not doesnt "
    "does_not didnt never without anything_but anything_except anything_other_than everything_but everything_except "
    "all_but "
    "except except_for apart_from other_than 除了 除 wont cant cannot shouldnt neednt no_need  "
    "no_need_to dont_need_to forget forget_about ignore nevermind never_mind dont_care dont_care_about "
    "do_not_care couldnt_care_less "
    "couldnt_care_less_about could_not_care_less "
    "dont_worry_about no_matter stop instead_of rather_than regardless_of avoid skip not_interested_in 不要 别 不用 "
    "不必 无需 不需要 不在乎 不关心 不在意 不管 不考虑 不 无须 无论 不管多少 无论多少 没必要 不想 停止 先不 "
    "忽略  "
    "不追求"
)
ISNT = "isnt arent wasnt 不是 并非 并不是"  # negates what follows, or else what stands before
NOT_AFTER = (
    "is_off are_off off turned_off switched_off is_disabled disabled is_out is_over is_unwanted unwanted undesired "
    "excluded forbidden not_wanted not_desired not_allowed out_of_the_question 关了 已关闭 已关 除外 免了 "
    "的我不在乎 的我不关心 的我不在意 的我不管 的不重要 我都不在乎 我都不管 我都不关心 "
    "doesnt_matter does_not_matter dont_matter do_not_matter not_important isnt_important unimportant irrelevant "
    "就别用了 别用了 就别用 就算了 就免了 不用了 不要了 就不要了 先不用 就不用了 别搞了 先别用 别用 "
    "no_object no_concern not_a_concern isnt_a_concern not_a_priority isnt_a_priority not_needed isnt_needed "
    "not_necessary 无所谓 不重要 没关系 不要紧 不是问题 随便"
)
POLITE = (
    "can_spare could_spare quick_question quick_check quick_look quick_word fair_enough fair_point fair_amount "
    "fair_bit fair_chance "
    "fair_warning to_be_fair apart_from_that other_than_that except_for_that no_matter_what regardless "
    "whatever_it_takes off_peak no_doubt 无论如何 不管怎样 不管怎么样 "
    "can could would will shall please lets let_us how_about what_about why_not why_dont is_it_possible_to "
    "i_want_you_to dont_forget do_not_forget not_only no_wait nothing_but make_sure green_light high_speed_train "
    "at_high_speed 能不能 能否 能 哪怕 赶快 尽快 可以 可不可以 请 帮 麻烦 要不要 不但 不仅 别忘了 不错 大家 大约 "
    "差不多 不好意思 大概 多个 快递 快乐 快照 快餐 愉快 凉快 痛快 快讯 快手 快车 慢性 慢跑 慢慢来"
)
SPLIT = "but instead however yet while whereas 但 但是 而 而是 不过"
JOIN = "and or nor plus 和 与 及 或 以及"
BALANCE = (
    "折个中 取个中间 取个中 取中间 找个平衡 平衡一下 balance balanced balancing tradeoff trade_off trade_offs "
    "compromise sweet_spot middle_ground 平衡 均衡 兼顾 "
    "权衡  "
    "折中 折衷 两全 取舍"
)
BOTH = "both 都要 都想要"
PAIRED = "又 又要 既 既要"  # two of them say "both"
OVER = "over"  # after a word of preference it sets one wish below another

# Topics.
FAIR = (  # in what?
    "equal equally equality evenly even_share even_shares equal_share equal_shares fair_power power_fairness "
    "均等 平均分配 平均 一视同仁"
)
FAIRLY = "fairly"  # of sharing; but "fairly fast" is only rather fast
SHARE = (
    "share shares shared sharing divide divided dividing distribute distributed distributing allocate allocated "
    "allocating assign assigned split splits splitting treat treated treating 分配 分享 共享"
)
SAME = (
    "same_rate same_rates same_speed same_speeds same_throughput same_data_rate equal_rate equal_speed "
    "equal_throughput equal_data_rate identical_rate identical_rates "
    "速率相同 速率相等 速率一样 速度相同 速度一样 网速一样 "
    "相同速率 相同的速率 同样的速率 同样速率 一样的速率 相等的速率 相同的速度 同样的速度 一样的速度"
)
EVERYONE = (
    "everyone everybody all each every each_user every_user all_users all_the_users all_of_them 所有 所有用户 所有人 "
    "每个 每人 每个用户 全部用户 各用户 人人 大家"
)
UNSUPPORTED = (
    "latency delay delays jitter ping response_time handover handovers coverage beamforming antenna antennas tilt "
    "interference roaming 时延 延迟 抖动 覆盖 切换 天线 干扰"
)
_NO_DATA = (
    "error bit_error block_error packet_error symbol_error failure fail loss packet_loss drop dropout outage miss "
    "collision retransmission churn frame refresh sample sampling symbol clock heart interest exchange tax"
)
STRANGE = (
    "fastest_user fastest_users strongest_user strongest_users best_user best_users 最快的用户 最快用户 最好的用户 "
    "max_min_power alpha_fair alpha_fairness alpha_fairly α_fair α_fairness α公平 "
    "jain jains jain_index "
    "weighted_fair weighted_fairness min_max round_robin same_rate_as same_speed_as keep_the_same_rate "
    "keep_the_same_speed at_the_same_rate at_the_same_speed with_the_same_rate with_the_same_speed packet_loss "
    "packet_losses errors ber bler 误码率 误块率 误比特率 错误率 丢包率 掉线率 失败率 帧率 采样率 利率 "
    + " ".join(f"{kind}_rate {kind}_rates" for kind in _NO_DATA.split())
)
DOMAIN = (
    "out_of_the_antenna from_the_antenna at_the_antenna through_the_antenna leave_the_antenna leaves_the_antenna "
    "leaving_the_antenna leaving_that_antenna "
    "unfair unfairly unfairness 不公平 公不公平 power_cut power_outage power_failure 比特 比例 user users ue "
    "subcarrier subcarriers channel channels csi cell "
    "cells network base_station allocation spectrum  "
    "signal snr sensor sensors iot device devices wireless internet wifi 5g 6g gain repair waterfilling 用户 小区 "
    "电路  "
    "子载波 信道 网络 基站 频谱 传感器 物联网 设备 信号 资源"
)
OFF_TOPIC = (
    "drop_table delete_from insert_into select_from "
    "weather joke football soccer pizza poem song music movie recipe stock stocks news president translate dinner "
    "lunch coffee cook holiday essay homework 天气 笑话 足球 比赛 电影 唱歌 诗 新闻 股票 星期 几点 吃饭 做饭 翻译 "
    "披萨  "
    "外卖"
)
COMMAND = "apply compare confirm history replay redo explain 应用 比较 对比 确认 历史 解释 解释一下"
UNDO = "undo revert rollback roll_back cancel 撤销 撤回 取消 回退"  # a command, and a negation of what follows
HELP = "help what_can_you_do what_do_you_do who_are_you 你能做什么 你会什么 帮助 你是谁"
QUESTION = (
    "why what whats which who whos how when where is are was were does did do_you do_we do_they do_users do_i 为什么 "
    "为何 怎么 什么 多少 哪个 哪些 哪 谁 吗 怎样 怎么样"
)
GREETING = "hello hi hey thanks thank_you good_morning good_evening 你好 您好 谢谢"

CONCEPTS: dict[str, str] = {
    "up": UP, "down": DOWN, "want": WANT, "keep": KEEP, "waste": WASTE, "bad": BAD,
    "isnt": ISNT, "strange": STRANGE, "rate": RATE, "stream": STREAM,
    "performance": PERFORMANCE, "power": POWER, "battery": BATTERY, "efficiency": EFFICIENCY, "not": NOT,
    "not_after": NOT_AFTER, "polite": POLITE, "split": SPLIT, "join": JOIN, "balance": BALANCE, "both": BOTH,
    "paired": PAIRED, "over": OVER, "fair": FAIR, "fairly": FAIRLY, "share": SHARE, "same": SAME, "everyone": EVERYONE,
    "worst": WORST, "unsupported": UNSUPPORTED, "domain": DOMAIN,
    "off_topic": OFF_TOPIC, "command": COMMAND, "undo": UNDO, "help": HELP, "question": QUESTION, "greeting": GREETING,
}  # fmt: skip

# Right words that are one letter away from a term: never "corrected".
RIGHT_WORDS = (
    "about after apple below boots cheap choose closer covers decay drawn early fairy fasten fester forests foster "
    "greed "
    "greet hangover large latte lease leash light liver losing lover mower night other paste poker powder price "
    "quiet  "
    "quite relay sleep small spend spent steak steal steam steed taste their there these those tower treat under "
    "waits  "
    "wants witch"
)
