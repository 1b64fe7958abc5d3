"""A conversation with memory: sentences in, turns out.

    session = wa.Session(scene, wa.loss.random(0.2), seed=1)
    print(session.say("Highest total rate, at most 10 W").reply)
    print(session.say("and at least 1 Mbit/s for everyone").reply)

What is asked for, what was decided and what is in effect are kept as immutable states, so that "undo" goes back to
each of them. The recogniser only says what is meant; what is done about it is decided here, and the same for all of
them.
"""

from __future__ import annotations

import dataclasses
import re
import uuid
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from typing import Any, Protocol, TypeAlias, cast

from wirelessagent import __version__
from wirelessagent.acting.base_station import BaseStation
from wirelessagent.agent import asking, changing, posing, supposing
from wirelessagent.agent.acting import TOLERANCE
from wirelessagent.agent.posing import RefusedError, UnknownUserError, user_number
from wirelessagent.agent.state import Decide, InsteadError, Reply, Site, State, Talk, asked_back, decided, station_of
from wirelessagent.agent.turn import Done, Lines, Run, Tools, Turn, shift_between, unmet
from wirelessagent.language.acts import Act, Aim, Apply, Ask, AskStatus, Export, No, Press, Suppose, Undo, Yes
from wirelessagent.language.conversation import NAME as READ_HERE
from wirelessagent.language.conversation import called, unanswered, understood, with_users
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.possible import spoken_of
from wirelessagent.language.intent import OWN_CHOICE, Intent, acts_of
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Missing, Question, Recogniser
from wirelessagent.language.request import Request, difference, users_in
from wirelessagent.model.errors import UnclearRequestError, UnsupportedProblemError, WirelessAgentError
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.telling.catalogue import Progress, message, silent

_NOTE = re.compile(r"[(（][^()（）]+[)）]$")
"""What a recogniser that read a line in another one's place says of itself at the end of a reply."""

_REPLIES = {**changing.REPLIES, **supposing.REPLIES, **asking.REPLIES}

_BUTTONS: Mapping[Press, tuple[str, Act]] = {
    "yes": ("confirm", Yes()), "no": ("reject", No()), "undo": ("undo", Undo()),
}  # fmt: skip
"""The topic and the act of each button."""

Understand: TypeAlias = Callable[[str, Context, Recogniser], Intent]
"""What says what a line means."""


class TurnStore(Protocol):
    """What keeps turns for good."""

    def append(self, turn: Turn) -> object:
        """Keep a turn, whole or not at all."""
        ...


class Session:
    """A conversation about one cell.

    Args:
        scene: the cell and its channel.
        losses: what gets lost of what is sensed.
        seed: of every draw.
        recogniser: what understands sentences; the offline one if not given.
        base_station: where allocations are applied: one of your own, or a registered name in ``tools``; a simulated
            one if neither is given and the true channel is known.
        confirm: whether to ask before anything is applied; None asks unless the base station is simulated.
        tolerance: share by which what is achieved may fall short before the last good allocation is put back.
        tools: the repairer, the method and the base station by name, with their options.
        store: keeps every turn.
        progress: is told of each stage as it happens.
        raises: raise what goes wrong instead of telling it; questions back are told all the same.
        station_of: finds the base station for tools and a scene, where none is given.
        decide: makes the decisions.
        understand: says what a line means in its conversation, with the recogniser's help.
    """

    def __init__(
        self,
        scene: Scene,
        *losses: Loss,
        seed: int = 0,
        recogniser: Recogniser | None = None,
        base_station: BaseStation | None = None,
        confirm: bool | None = None,
        tolerance: float = TOLERANCE,
        tools: Tools | None = None,
        store: TurnStore | None = None,
        progress: Progress = silent,
        raises: bool = False,
        station_of: Callable[[Tools, Scene], BaseStation | None] = station_of,
        decide: Decide = decided,
        understand: Understand = understood,
    ) -> None:
        self._site = Site(
            scene, losses, seed=seed, tools=tools or Tools(), base_station=base_station, confirm=confirm,
            tolerance=tolerance, progress=progress, station_of=station_of, decide=decide,
        )  # fmt: skip
        self._recogniser, self._understand = recogniser or OfflineRecogniser(), understand
        self._store, self._raises = store, raises
        self._state, self._past = State(), list[State]()
        self._turns, self._requests = list[Turn](), list[Request | None]()
        self._language = self._by = ""
        self.id = uuid.uuid4().hex[:12]

    @property
    def user_names(self) -> tuple[str, ...]:
        """The users of the channel that it is about."""
        return self._site.user_names

    @property
    def turns(self) -> tuple[Turn, ...]:
        """What was said so far."""
        return tuple(self._turns)

    @property
    def request(self) -> Request | None:
        """What is asked for: its objective and its constraints; None at the start."""
        return self._state.request

    @property
    def state(self) -> State:
        """What holds: the request, the decision, what waits for a yes, and what is in effect."""
        return self._state

    @property
    def language(self) -> str:
        """The operator's, as of the last line; English before the first."""
        return self._language or "en"

    def say(self, text: str, *, by: str = "", pressed: Press | None = None) -> Turn:
        """Take a line from the operator (``by`` name, where that is known): understand it, do what it asks, reply.

        Where a button was ``pressed``, that is what is meant; nothing is read in the text and nothing doubted.
        """
        self._by = by
        context = self._context()
        if pressed is None:
            missing = None if self._state.question is None else self._state.question.missing
            named = None if missing is None else posing.completed(missing, text.strip(), context)
            intent = self._taken(named or self._understand(text, context, self._recogniser))
        else:
            topic, act = _BUTTONS[pressed]
            intent = Intent(
                kind="command", objective=None, constraints={}, language=self.language, confidence=1.0, evidence={},
                reply=text, recogniser=READ_HERE, topic=topic, acts=(act,),
            )  # fmt: skip
        self._state = dataclasses.replace(self._state, supposed=None)
        self._language = intent.language
        talk = Talk(
            site=self._site, state=self._state, past=self._past, turns=self._turns, intent=intent, text=text,
            language=intent.language, pressed=pressed,
        )  # fmt: skip
        if intent.kind == "allocate":
            reader, sure = intent.recogniser, f"{intent.confidence:.0%}"
            read = talk.say("stage.understood", reply=intent.reply, recogniser=reader, sure=sure)
            self._site.tell("understand", read, intent.language)
        try:
            reply = _naming_the_plan(self._reply(talk, context), talk, acts_of(intent))
            self._take(talk, reply)
        except BaseException:  # an interruption too: the base station may have it, or a part of it
            if self._site.telling is not None:
                unknown, told = dataclasses.replace(self._state.settled, on_air=None), talk.say("station.broken_off")
                reply = Reply(changed=told, stage="nothing", state=unknown, run=self._site.telling)
                self._take(talk, reply)
                self._kept(talk, reply)
            raise
        return self._kept(talk, reply)

    def _context(self) -> Context:
        state, request, supposed = self._state, self._state.request, self._state.supposed
        names = dict(called([turn.text for turn in self._turns]))
        for turn in self._turns:  # who "the ambulance" is was asked, and answered
            told = cast("Mapping[str, tuple[str]]", turn.intent.details.get("called") or {})
            names |= {name: number for name, (number,) in told.items()}
        return Context(
            user_names=self._site.user_names, max_power_w=self._site.scene.cell.max_power_w, language=self._language,
            radiated_w=state.radiated_w, objective=None if request is None else request.objective,
            constraints={} if request is None else request.constraints,
            awaits=state.awaits, question=state.question or Question(),
            supposed_objective=None if supposed is None else supposed.objective,
            supposed={} if supposed is None else supposed.constraints,
            ways=unmet(self._turns) is not None, offers=len(state.offers),
            acts=self._last_acts(), spoken_of=self._spoken_of(names), called=names,
            earlier=tuple(turn.acts for turn in self._turns), past=tuple(state.request for state in self._past),
        )  # fmt: skip

    def _last_acts(self) -> tuple[Act, ...]:
        """The acts of the last line that changed something, or of the very last one where that supposed something."""
        for turn in reversed(self._turns):
            acts = tuple(act for act in turn.acts if _changes_or_supposes(act))
            if acts and (turn is self._turns[-1] or not any(isinstance(act, Suppose) for act in acts)):
                return acts
        return ()

    def _spoken_of(self, names: Mapping[str, str]) -> tuple[str, ...]:
        """The users whom the last line that named any named, unless something was changed since."""
        for turn in reversed(self._turns):
            said = Anchored.of(with_users(turn.text, names), turn.intent.language, self._site.user_names)
            acts = [*filter(_changes_or_supposes, turn.acts)]
            users = spoken_of(said, len(self._site.user_names), acts)
            if users or acts:
                return users
        return ()

    def _reply(self, talk: Talk, context: Context) -> Reply:
        """What the intent leads to; what cannot be done becomes a reply, and changes nothing."""
        intent = talk.intent
        try:
            reply = _handled(talk, context)
            if reply.run is None or reply.stage == "answered":  # an answer has tables of its own
                return reply
            return dataclasses.replace(reply, tables=reply.run.tables(talk.language))
        except InsteadError as instead:
            return instead.reply
        except UnclearRequestError as question:
            reference = question.reference if isinstance(question, UnknownUserError) else None
            missing = None if reference is None else Missing(intent=intent, reference=reference)
            sure = {name: value for name, value in intent.constraints.items() if not isinstance(value, Mapping | tuple)}
            open_ = Question(pending=sure if missing is None else {}, objective=intent.objective, missing=missing)
            return asked_back(str(question), dataclasses.replace(self._state, planned=None, question=open_))
        except WirelessAgentError as error:
            if self._raises:
                raise
            if isinstance(error, RefusedError):
                changed = talk.say("plan.nothing_changed")
                return Reply(decided=str(error), changed=changed, stage="nothing", error=error)
            key = "refused.unsupported" if isinstance(error, UnsupportedProblemError) else "refused.failed"
            return Reply(decided=talk.say(key, why=error), stage="nothing", error=error)

    def _take(self, talk: Talk, reply: Reply) -> None:
        """Let what the reply brought hold, and remember what held before another request."""
        self._site.telling = None
        before, new = self._state, reply.state
        if new is None:
            new = dataclasses.replace(before, question=Question() if reply.stage == "asked" else before.waiting)
        elif reply.undone:
            del self._past[-reply.undone :]
        elif new.request != before.request:
            self._past.append(before.settled)
        noted = before.noted_after(reply.run, requested=talk.intent.kind == "allocate")
        self._state = dataclasses.replace(new, noted=noted)
        self._requests.append(new.request)

    def _kept(self, talk: Talk, reply: Reply) -> Turn:
        """The turn, remembered and stored; a store that fails is told of and stops nothing."""
        intent, before, after = talk.intent, talk.state, self._state
        lines = Lines(decided=reply.decided, changed=reply.changed, needs=reply.needs)
        by_another = intent.recogniser not in (self._recogniser.name, READ_HERE)
        if by_another and not (intent.reply and intent.reply in str(lines)):
            own = _NOTE.search(intent.reply) if " (" in intent.recogniser else None
            fallen_back = talk.say("stage.fallen_back", recogniser=intent.recogniser)
            lines = lines.ending_with(fallen_back if own is None else own[0], intent.language)
        run = reply.run if reply.stage != "answered" else None
        then, now = before.run and before.run.decision, run and run.decision
        turn = Turn(
            number=len(self._turns) + 1, session=self.id, text=talk.text, intent=intent, lines=lines,
            at_utc=datetime.now(UTC).isoformat(timespec="milliseconds"), version=__version__, seed=self._site.seed,
            recogniser=intent.recogniser, by=self._by, pressed=talk.pressed,
            diff=difference(before.request, after.request), shift=shift_between(then, now),
            **{field.name: getattr(reply, field.name) for field in dataclasses.fields(Done)},
        )  # fmt: skip
        if self._store is not None:
            try:
                self._store.append(turn)
            except WirelessAgentError as error:
                told = lines.ending_with(talk.say("stage.not_recorded", why=error), talk.language)
                turn = dataclasses.replace(turn, lines=told)
        self._turns.append(turn)
        return turn

    def _taken(self, intent: Intent) -> Intent:
        """The request of an earlier turn, or one that was offered, for a line that takes it; any other as it is."""
        taken: dict[str, Any] = {}
        match next(iter(acts_of(intent)), None):
            case Undo(turn=int(number)) if number in range(1, len(self._requests) + 1):
                request = self._requests[number - 1]
                if request is not None:
                    reply = message(intent.language, "request.back_to_turn", number=number)
                    details = {"turn": number, "method": request.method or OWN_CHOICE}
                    taken = {"constraints": request.constraints, "reply": reply, "details": details}
            case Yes(choice=int(choice)):
                request, offers = self.request, self._state.offers
                place = choice - 1 if choice > 0 else len(offers) - 1
                if request is not None and 0 <= place < len(offers):
                    acts = (Aim(objective=request.objective), *offers[place])
                    taken = {"amends": True, "details": {}, "acts": acts}
            case _:
                return intent
        if request is None or not taken:
            return intent
        return dataclasses.replace(intent, kind="allocate", objective=request.objective, topic=None, **taken)


def _changes_or_supposes(act: Act) -> bool:
    """Whether the line behind an act may lean on it."""
    return not isinstance(act, Ask | Apply | Yes | No) and act != Suppose()


def _handled(talk: Talk, context: Context) -> Reply:
    """What becomes of a line: of all that it wants changed together, else of its question or its command."""
    intent, acts = talk.intent, acts_of(talk.intent)
    if intent.kind == "allocate":
        return changing.allocate(talk, acts)
    if intent.kind == "clarify":
        return _open_question(talk, context)
    if intent.kind == "out_of_scope":
        return Reply(decided=intent.reply)
    return _REPLIES[type(acts[0])](talk, acts[0])


def _open_question(talk: Talk, context: Context) -> Reply:
    """A question back, with what was understood before it."""
    intent = talk.intent
    for reference in users_in(intent.pending):  # who is not there is asked about first
        user_number(reference, talk.site.user_names, intent.language)
    left = unanswered(talk.text, intent, context)
    if changing.is_about_the_plan(talk, left):
        return changing.asked_again(talk)
    question = left if intent.guess is None else Question(guess=intent.guess)
    return asked_back(intent.reply, dataclasses.replace(talk.state, planned=None, question=question))


def _naming_the_plan(reply: Reply, talk: Talk, acts: tuple[Act, ...]) -> Reply:
    """The answer to something else, with the plan that still waits as what it needs; a document stays as it is."""
    before, after = talk.state, reply.state or talk.state
    waits = after.planned is not None and after.planned is before.planned and after.question is None
    whole = any(isinstance(act, Export | AskStatus) for act in acts)
    if not waits or whole or reply.needs or reply.stage not in ("answered", "nothing"):
        return reply
    return dataclasses.replace(reply, needs=talk.say("plan.still_waits", request=talk.plan(after.request)))


def ask(
    text: str,
    scene: Scene,
    *losses: Loss,
    seed: int = 0,
    tools: Tools | None = None,
    progress: Progress = silent,
) -> Run:
    """Run the chain once on a scene as a sentence asks, with what ``losses`` leave of the channel.

    Raises:
        UnclearRequestError: the sentence is not clear; the message is the question to the operator.
    """
    session = Session(scene, *losses, seed=seed, tools=tools, confirm=False, progress=progress, raises=True)
    turn = session.say(text)
    if turn.run is None:
        raise UnclearRequestError(turn.reply)
    return turn.run
