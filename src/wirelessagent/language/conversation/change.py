"""One change that a line of a talk may make, and how the line says it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from wirelessagent.language.acts import Act
from wirelessagent.language.conversation.anchors import Anchor
from wirelessagent.language.conversation.possible import Effect, Group


@dataclass(frozen=True, kw_only=True)
class Change:
    """One change that a line may make, and how the line says it.

    Attributes:
        acts: what makes it.
        effect: what it comes to.
        form: what is done: a figure is set, added, scaled, a user is left out, ...
        kind: of which limit.
        source: where the users whom it is about are from: "named" in the line, of the "last" act, "others", ...
        figure: that the line says, None where it needs none.
        users: where the line names them.
        model: where it names the user whose figure it is.
    """

    acts: tuple[Act, ...]
    effect: Effect
    form: str
    kind: str = ""
    source: str = ""
    figure: Anchor | None = None
    users: tuple[Anchor, ...] = ()
    model: Anchor | None = None

    @property
    def is_supposition(self) -> bool:
        """Whether it changes nothing, and says of others that they are only supposed."""
        return not self.acts

    @property
    def is_of_readers(self) -> bool:
        """Whether it is all that the reader of sentences makes of the line, or asks about."""
        return self.form in ("read", "guessed")

    @property
    def is_said(self) -> bool:
        """Whether it is about whom the line says, and not about those who are left or happen to be alike."""
        return not self.source.startswith(("not:", "alike:"))


def change_for(
    group: Group, acts: Sequence[Act], form: str, kind: str = "", figure: Anchor | None = None,
    model: Anchor | None = None,
) -> Change:  # fmt: skip
    """A change for a group, whose effect is not worked out yet."""
    return changed_by(acts, form, kind, group.source, figure, group.anchors, model)


def changed_by(
    acts: Sequence[Act], form: str, kind: str = "", source: str = "", figure: Anchor | None = None,
    users: tuple[Anchor, ...] = (), model: Anchor | None = None,
) -> Change:  # fmt: skip
    """A change by acts, whose effect is not worked out yet."""
    return Change(
        acts=tuple(acts), effect=frozenset(), form=form, kind=kind, source=source, figure=figure, users=users,
        model=model,
    )  # fmt: skip
