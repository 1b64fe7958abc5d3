"""Everything that a line of a talk may change of what holds, by its figures, its users and what was said before.

Which of it the line means is weighed elsewhere (:mod:`.weighing`); nothing else can be meant, so that no line changes a
figure that neither it nor the talk says.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

from wirelessagent.language.acts import Act, Everybody, Limit
from wirelessagent.language.conversation.change import Change
from wirelessagent.language.conversation.effects import may_hold
from wirelessagent.language.conversation.figures_said import corrected, of_figures, of_shares
from wirelessagent.language.conversation.possible import Possible
from wirelessagent.language.conversation.steps_back import back_and_aims
from wirelessagent.language.conversation.users_said import like_another, of_limits, of_users
from wirelessagent.language.intent import EVERYBODY, is_allowed

_SAID = (of_figures, of_shares, corrected, like_another, of_users, of_limits, back_and_aims)


def changes_of(possible: Possible) -> list[Change]:
    """Each that a line may say; what can't hold, or holds already, comes to nothing."""
    found = itertools.chain.from_iterable(said(possible) for said in _SAID)
    effects = ((each, possible.effect(each.acts)) for each in found if each.acts)
    return [
        dataclasses.replace(each, effect=effect if may_hold(effect) and _may_be_set(each.acts) else frozenset())
        for each, effect in effects
    ]


def _may_be_set(acts: Sequence[Act]) -> bool:
    """Whether each figure that acts set is one that a limit may have."""
    limits = ((act, EVERYBODY if isinstance(act.whom, Everybody) else "") for act in acts if isinstance(act, Limit))
    return all(is_allowed(limit.kind, limit.value, user=user) for limit, user in limits)
