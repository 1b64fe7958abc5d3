"""What the paper claims, and what each claim is judged by.

The paper is Yi et al., *WirelessAgent: A Unified Agent Design for General Wireless Resource Allocation Problem without
Current Channel State Information*. A claim is a row of data: its words, where they stand, and bars for figures that the
experiments measure. Where the words give no figure, one of the limits below stands for them.
"""

from __future__ import annotations

from wirelessagent.experiments.error_sweep import CLAIMED_CUT
from wirelessagent.experiments.verdict import Bar, Claim, Reading

_NOTICEABLE = 5.0
"""In %: a gap of no more is "small" or "close"; a difference of no less is "noticeable" or "significant"."""
_FOLLOWED = 81.0
"""In %: the share of the fading that a "close" fit explains; that of a correlation of 0.9, usually called very high."""
_FULL = 99.99
"""In %: the share of the budget that is all of it, but for the bisection's last step."""
_FOUND = 0.1
"""In %: how far from the certified bound an optimum may lie that was "identified", less than figures show."""
_KEPT = 95.0
"""In %: the share of users who get the rate that was to be met."""
_LINEAR = 1.1
"""The largest exponent that is linear: caches alone cost some hundredths."""

_CUT = 100.0 * CLAIMED_CUT


def _cut(measure: str, what: str) -> Bar:
    return Bar(measure=measure, what=what, side="at least", limit=_CUT)


def _explained(repairer: str, what: str) -> Bar:
    return Bar(measure=f"explained_by_{repairer}", what=what, side="at least", limit=_FOLLOWED)


def _at_least_noticeable(measure: str, what: str) -> Bar:
    return Bar(measure=measure, what=what, side="at least", limit=_NOTICEABLE)


def _minimum(who: str, what: str) -> tuple[Bar, Bar]:
    """Power near the least possible, and rates that arrive."""
    return (
        Bar(measure=f"excess_power_{who}", what=f"{what}: power above the certified minimum", side="at most",
            limit=_NOTICEABLE),
        Bar(measure=f"users_served_{who}", what=f"{what}: users who get their rate on the true channel",
            side="at least", limit=_KEPT),
    )  # fmt: skip


def _linear(stage: str, sizes: str) -> tuple[Bar, ...]:
    return tuple(
        Bar(measure=f"exponent_in_{size}_of_{stage}", what=f"exponent of the time in {size}", side="at most",
            limit=_LINEAR)
        for size in sizes
    )  # fmt: skip


CLAIMS: tuple[Claim, ...] = (
    Claim(
        words="the proposed AI method reduces the root mean square error by approximately up to 67% compared to the "
        "traditional approach",
        place="abstract",
        experiments=("error_versus_delay_spread", "error_versus_user_correlation"),
        printed=(_cut("best_cut_as_printed", "NNCF as printed, at its best delay spread"),),
        otherwise=(
            Reading(
                condition="all users have the same path loss and their channels are correlated by at least "
                "{correlation_needed_as_printed}",
                bars=(_cut("cut_as_printed_of_alike_users", "NNCF as printed, all users alike"),),
            ),
            Reading(
                condition="neighbours count relative to their own user's level and the RMS delay spread is at most "
                "{reach_of_nncf}",
                bars=(_cut("cut_by_nncf", "NNCF with relative gains, usual delay spread"),),
            ),
            Reading(
                condition="the default repairer is used and the RMS delay spread is at most {reach_of_kriging}",
                bars=(_cut("cut_by_kriging", "kriging, usual delay spread"),),
            ),
        ),
        comment="as printed the cut is largest at {best_delay_spread_as_printed}, in absolute gain, which the "
        "strongest users rule; relative to each user's level its error is {error_ratio_as_printed} times that of mean "
        "filling, in the median draw at {usual_delay_spread}",
    ),
    Claim(
        words="It accurately reconstructs the missing channel gains, fitting the trend of the ground truth curve "
        "closely.",
        place="section IV.B, on Fig. 2",
        experiments=("channel_recovery",),
        printed=(_explained("nncf_paper", "fading explained by NNCF as printed"),),
        otherwise=(
            Reading(
                condition="neighbours count relative to their own user's level",
                bars=(_explained("nncf", "fading explained by NNCF with relative gains"),),
            ),
            Reading(
                condition="the default repairer is used",
                bars=(_explained("kriging", "fading explained by kriging"),),
            ),
        ),
        comment="all at {usual_spread} of delay spread; the printed rule averages gains of users as they stand, whose "
        "levels differ by {level_spread} in the median draw",
    ),
    Claim(
        words="achieves a performance close to the upper bound with Perfect CSI (Black line), maintaining a small gap "
        "across the entire power range",
        place="section IV.B, on Fig. 3",
        experiments=("rate_versus_power",),
        printed=(
            Bar(measure="least_sum_rate_share_of_nncf_paper", what="NNCF as printed: least share of the sum rate",
                side="at least", limit=100.0 - _NOTICEABLE),
        ),
        comment="beside it mean filling keeps {least_sum_rate_share_of_user_mean}, "
        "the default repairer {least_sum_rate_share_of_kriging}",
    ),
    Claim(
        words="the traditional baseline (Blue dashed line) suffers from noticeable performance degradation due to "
        "inaccurate channel estimation",
        place="section IV.B, on Fig. 3",
        experiments=("rate_versus_power",),
        printed=(_at_least_noticeable("largest_sum_rate_loss", "mean filling: largest loss of sum rate"),),
        otherwise=(
            Reading(
                condition="a rate counts as committed on the estimate, and only where the true channel carries it "
                "(goodput)",
                bars=(_at_least_noticeable("largest_goodput_loss", "mean filling: largest loss of goodput"),),
            ),
        ),
        comment="with ideal link adaptation mean filling keeps {least_sum_rate_share_of_user_mean} of the sum rate: a "
        "filled gain seldom changes who is best on a subcarrier. In goodput it keeps "
        "{least_goodput_share_of_user_mean}, the default repairer {least_goodput_share_of_kriging}",
    ),
    Claim(
        words="the high-precision channel reconstruction provided by the AI module directly translates into "
        "significant system-level throughput gains",
        place="section IV.B, on Fig. 3",
        experiments=("rate_versus_power",),
        printed=(_at_least_noticeable("largest_sum_rate_gain", "NNCF as printed over mean filling: sum rate"),),
        otherwise=(
            Reading(
                condition="throughput is goodput",
                bars=(_at_least_noticeable("largest_goodput_gain", "NNCF as printed over mean filling: goodput"),),
            ),
        ),
        comment="and it is not precision that pays: the printed rule keeps {least_goodput_share_of_nncf_paper} of the "
        "goodput of perfect CSI, the more precise relative gains {least_goodput_share_of_nncf}; a rate is lost where a "
        "gain was guessed too high, by however little",
    ),
    Claim(
        words="In the Max Rate mode, the system allocates the full power budget (20 W) to subcarriers with high "
        "channel gains",
        place="section IV.C",
        experiments=("modes",),
        printed=(
            Bar(measure="radiated_share_as_printed", what="share of the budget radiated", side="at least", limit=_FULL),
        ),
    ),
    Claim(
        words="In the Min Power mode, the system successfully calculates the minimum power required to meet the QoS "
        "constraints",
        place="section IV.C",
        experiments=("modes",),
        printed=_minimum("as_printed", "as printed"),
        otherwise=(
            Reading(
                condition="power is searched by prices, gains are repaired by default, and rates are promised with a "
                "probability",
                bars=_minimum("promised", "promised by default"),
            ),
        ),
    ),
    Claim(
        words="significantly reducing energy consumption compared to fixed-power schemes",
        place="section IV.C",
        experiments=("modes",),
        printed=(_at_least_noticeable("drawn_saving_as_printed", "power saved, the circuits' counted"),),
        comment="it carries {rate_share_of_fixed_power} of the rate that fixed power does, and "
        "{users_served_as_printed} of the users get theirs",
    ),
    Claim(
        words="In the Max EE mode, the algorithm identifies the optimal operating point where the ratio of throughput "
        "to power consumption is maximized",
        place="section IV.C",
        experiments=("modes",),
        printed=(
            Bar(measure="efficiency_gap_as_printed", what="efficiency below the certified optimum", side="at most",
                limit=_FOUND),
        ),
        comment="on the channel that it is given, with {power_levels} levels; the paper names no number",
    ),
    Claim(
        words="the NNCF channel repair requires O(I_iter K N) operations",
        place="section III.C",
        experiments=("run_time",),
        printed=_linear("repair_by_nncf_paper", "KN"),
    ),
    Claim(
        words="For resource scheduling, the complexity is upper-bounded by the Max EE mode at O(LNK)",
        place="section III.C",
        experiments=("run_time",),
        printed=_linear("max_energy_efficiency_by_paper_scan", "LNK"),
    ),
)  # fmt: skip
"""In the order of the paper's results."""
