"""The guard: what is not clearly asked for now is asked about, first and in talks, whoever recognises."""

from __future__ import annotations

import dataclasses

import pytest
from conversations import asks
from llm_stub import StubLlm, meaning

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.language.conversation import understood
from wirelessagent.language.guard import doubted, is_bent, stranger
from wirelessagent.language.llm.client import LlmSettings
from wirelessagent.language.llm.reader import LlmRecogniser
from wirelessagent.language.moods import table_of
from wirelessagent.language.offline import OfflineRecogniser, recognise
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.word_tables import languages_with

USERS = tuple(f"user {number}" for number in range(1, 5))
SCENE = wa.simulate("rayleigh", num_users=4, num_subcarriers=16, seed=3)
HELD = Context(user_names=USERS, objective="proportional_fairness", constraints={"max_power_w": 12.0}, language="en")
NOT_ASKED = {
    "negation": (
        "Max total rate, but user 3 is not to get 2 Mbit/s", "最大总速率，用户3不要给2 Mbit/s了",
        "No gastes menos potencia",
    ),
    "refusal": (
        "I refuse to go for max total rate", "我拒绝最大总速率", "Me niego a la máxima velocidad total",
        "Je refuse le débit total maximal", "Maximale Summenrate kommt nicht in Frage", "Max total rate? No.",
    ),
    "report": (
        "The boss told me: max total rate with 10 W", "据说这里用的是最大总速率",
        "Según el registro, máxima velocidad total",
        "Il paraît qu'on a le débit total maximal", "Angeblich läuft maximale Summenrate",
    ),
    "quotation": (
        'The note reads "max total rate"', "牌子上写着“最大总速率”", "El letrero: «máxima velocidad total»",
        "Le panneau : « débit total maximal »", "Auf dem Zettel: „maximale Summenrate“",
    ),
    "past": (
        "Yesterday we had max total rate", "昨天是最大总速率", "Ayer usábamos la máxima velocidad total",
        "Hier on avait le débit total maximal", "Gestern hatten wir maximale Summenrate",
    ),
    "time": (
        "Tomorrow at nine, max total rate", "明天再最大总速率", "El lunes, máxima velocidad total",
        "Demain, débit total maximal", "Nächste Woche maximale Summenrate",
    ),
    "condition": (
        "If the crowd comes, max total rate", "如果人多，就最大总速率", "Si viene gente, máxima velocidad total",
        "Si la foule arrive, débit total maximal", "Wenn viele kommen, maximale Summenrate",
    ),
    "irony": (
        "Max total rate for the cows, haha", "呵呵，最大总速率", "Qué gran idea, máxima velocidad total",
        "Bravo, débit total maximal", "Na toll, maximale Summenrate",
    ),
    "others": (
        "Marketing wants max total rate", "市场部想要最大总速率", "La directora quiere la máxima velocidad total",
        "Le voisin souhaite le débit total maximal", "Der Vertrieb verlangt maximale Summenrate",
    ),
    "elsewhere": (
        "Max total rate on the uplink", "隔壁小区要最大总速率", "Máxima velocidad total en la celda vecina",
        "Débit total maximal pour la cellule voisine", "Maximale Summenrate für das WLAN",
    ),
}  # fmt: skip
ASKED_FOR = (
    "From now on max total rate, no more than 10 W", "Max total rate, the power must not exceed 10 W",
    "Max total rate without user 3", "Max total rate, nobody below 200 kbit/s", "Don't serve user 3, max total rate",
    "Everyone except user 3 gets 300 kbit/s, max total rate", "Max total rate, no minimum for user 4, 1 Mbit/s each",
    "Not speed but power saving", "I'd like max total rate, if possible with 10 W",
    "Why not go for max total rate", "Speed, not power saving",
    "I asked for nothing yesterday, but max total rate, please",
    "The board wants results, so maximise the total rate", "从现在起最大总速率，不超过10瓦", "不服务用户3，最大总速率",
    "Máxima velocidad total desde ahora, sin pasar de 10 W", "Débit total maximal dès maintenant, pas plus de 10 W",
    "Ab sofort maximale Summenrate, keiner unter 200 kbit/s",
)  # fmt: skip


WISHES = {
    "en": ("max total rate", "save power with 200 kbit/s each", "make the slowest user as fast as possible"),
    "zh": ("总速率最大", "功率降到最低，每人200 kbit/s", "让最慢的用户尽量快"),
    "es": ("maximiza la velocidad total", "potencia mínima con 200 kbit/s por usuario"),
    "fr": ("maximise le débit total", "puissance minimale avec 200 kbit/s chacun"),
    "de": ("maximiere die Summenrate", "minimale Sendeleistung mit 200 kbit/s für jeden"),
}
GOVERNED = {  # the words of a mood govern the wish that a template is filled with
    "en": (
        "Tomorrow at nine, {}",
        "{}, starting Monday",
        "He told me: {}",
        "My boss insists that, as it was slow, {}",
        "{}, he said",
        "I heard, {}",
        "{}, that was the plan",
        "When the guests are gone, {}",
        "Not today, but tomorrow {}",
        "Tomorrow is match day, then {}",
        "Later, {}",
        "On no account {}",
        "As of Monday, {}",
        "Since Monday, {}",
        "For the cell next door, {}",
        "{}? I refuse",
    ),
    "zh": ("明天九点，{}", "他说，{}", "如果人多，{}", "隔壁小区，{}"),
    "es": ("Mañana a las nueve, {}", "Según el registro, {}", "Si viene gente, {}"),
    "fr": ("Demain, {}", "Il paraît que, {}", "Si la foule arrive, {}"),
    "de": ("Morgen um neun, {}", "Angeblich: {}", "Wenn viele kommen, {}", "Die Chefin meinte, {}"),
}
FREE = {  # they stand beside the wish, and say something else
    "en": (
        "Since the guests are coming tomorrow, {}",
        "We lost the mains last night and it was a mess, {}",
        "It was slow yesterday, so {}",
        "We have been on the battery since 4 am: {}",
        "I'd appreciate it: {}",
        "The boss wants something else, but {}",
        "It's 8 pm, {}",
        "Once again: {}",
        "As agreed with the mayor yesterday, {}",
    ),
    "zh": ("因为今晚客人多，{}", "昨晚停电了，{}", "下个月电费要涨，现在{}", "今晚八点前{}", "客户投诉，所以{}"),
    "es": ("Como mañana no llega el gasóleo, {}", "Ayer se quejaron, así que {}", "Los vecinos se quejan, por eso {}"),
    "fr": ("Comme il sera livré lundi, {}", "Les clients se plaignaient hier, donc {}"),
    "de": ("Weil morgen kein Diesel kommt, {}", "Gestern haben sich alle beschwert, also {}"),
}


def session(**options: object) -> Session:
    return Session(SCENE, seed=1, confirm=False, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(("mood", "said"), [(mood, said) for mood, listed in NOT_ASKED.items() for said in listed])
@pytest.mark.parametrize("context", [Context(user_names=USERS), HELD], ids=["first", "later"])
def test_what_is_not_asked_for_now_is_asked_about(mood: str, said: str, context: Context) -> None:
    assert understood(said, context, OfflineRecogniser()).kind != "allocate", mood


@pytest.mark.parametrize("said", ASKED_FOR)
def test_a_word_that_the_act_accounts_for_asks_nothing(said: str) -> None:
    assert recognise(said).kind == "allocate"
    assert understood(said, HELD, OfflineRecogniser()).kind == "allocate"


def filled(templates: dict[str, tuple[str, ...]]) -> list[str]:
    """Every template of a language with every wish of it."""
    return [form.format(wish) for language, forms in templates.items() for form in forms for wish in WISHES[language]]


@pytest.mark.parametrize("said", filled(GOVERNED))
def test_whatever_is_wished_a_mood_that_governs_it_asks(said: str) -> None:
    assert recognise(said).kind != "allocate"
    assert understood(said, HELD, OfflineRecogniser()).kind != "allocate"


ASKED_FOR_NOTHING = ("We have been on the battery since 4 am: save power with 200 kbit/s each",)


@pytest.mark.parametrize("said", [said for said in filled(FREE) if said not in ASKED_FOR_NOTHING])
def test_whatever_is_wished_a_mood_beside_it_asks_nothing(said: str) -> None:
    assert recognise(said).kind == "allocate"


@pytest.mark.parametrize("said", ASKED_FOR_NOTHING)
def test_what_is_asked_about_for_nothing_is_done_for_a_plain_yes(said: str) -> None:
    guess = recognise(said).guess
    assert guess is not None
    assert guess.kind == "allocate"


def test_a_story_is_acted_on_where_an_order_takes_it_up_and_only_there() -> None:
    intent = dataclasses.replace(asks("min_power"), evidence={"min_rate_bps": "2 Mbit/s"})
    for story in ("User 3 wants 2 Mbit/s", "User 3 was promised 2 Mbit/s"):
        assert doubted(story, None, intent)
        for order in ("give him that", "so grant it", "so see to it"):
            assert doubted(f"{story}, {order}", None, intent) is None, order
        for order in ("don't give it to him", "forget it", "so he can stream", "and so what"):
            assert doubted(f"{story}, {order}", None, intent), order


@pytest.mark.parametrize(
    "said", ["Start over, I've been told the figures were wrong", "That was not what I wanted, undo it"]
)
def test_a_command_is_no_part_of_the_story_beside_it(said: str) -> None:
    assert recognise(said).kind == "command"
    assert recognise("The boss wants us to start over").kind != "command"


@pytest.mark.parametrize(
    ("said", "against"),
    [("Yesterday we had max total rate", "Yesterday"), ("If the crowd comes, max total rate", "If"),
     ("明天九点，总速率最大", "明天"), ("Il paraît que, maximise le débit total", "paraît")],
)  # fmt: skip
def test_the_words_that_speak_against_it_are_told(said: str, against: str) -> None:
    doubt = doubted(said, None, asks("max_rate"))
    assert doubt is not None
    assert against in said[slice(*doubt)]


def test_every_language_has_the_same_classes() -> None:
    tables = {language: table_of(language) for language in languages_with("moods")}
    assert all(list(table) == list(tables["en"]) for table in tables.values())
    for table in tables.values():
        for words in (words for classes in table.values() for words in classes.values()):
            assert all(word and word == word.strip() for word in words)
        for mood in NOT_ASKED:
            assert set(table[mood]) <= {"clause", "ahead", "sentence", "text", "here", "first"}
            assert any(table[mood].values())


def test_a_yes_takes_the_guess_up_and_a_no_drops_it() -> None:
    for lines in ((), ("proportional fairness",)):
        for answer in ("yes", "yes, please", "ok"):
            talk = session()
            for line in lines:
                talk.say(line)
            held = talk.request
            turn = talk.say("Tomorrow at eight, minimum power with 100 kbit/s each")
            assert turn.stage == "asked"
            assert "Tomorrow" in turn.reply
            assert "100 kbit/s" in turn.reply
            assert talk.request == held
            assert talk.say(answer).stage == "applied"
            assert talk.request is not None
            assert (talk.request.objective, dict(talk.request.constraints)) == ("min_power", {"min_rate_bps": 1e5})
        talk = session()
        for line in lines:
            talk.say(line)
        held = talk.request
        talk.say("明天最小功率，每人100 kbit/s")
        assert talk.say("不").stage == "nothing"
        assert talk.say("yes").stage != "applied"
        assert talk.request == held


def test_a_guess_leaves_no_figure_behind() -> None:
    talk = session()
    talk.say("Yesterday it was max total rate at 3 W")
    talk.say("proportional fairness")
    assert talk.request is not None
    assert not talk.request.constraints


@pytest.mark.parametrize(
    ("said", "who"),
    [
        ("Least power, 200 kbit/s for Brenda", "Brenda"), ("Promise Mr. Okafor 200 kbit/s", "Okafor"),
        ("给张经理保证200 kbit/s，总速率最大", "张经理"),
        ("Débit total maximal, 200 kbit/s pour Madame Lefèvre", "Lefèvre"),
        ("Max total rate, leave out Pedro", "Pedro"),
    ],
)  # fmt: skip
def test_somebody_who_is_no_user_never_becomes_everybody(said: str, who: str) -> None:
    talk = session()
    turn = talk.say(said)
    assert turn.stage == "asked"
    assert who in turn.reply
    assert not turn.intent.pending
    assert talk.say("yes").stage != "applied"
    assert recognise(said).kind == "clarify"


@pytest.mark.parametrize(
    ("said", "answer", "held"),
    [
        ("max rate without the scanner", "user 3", {"leave_out": ("3",)}),
        ("fair shares, 500 kbit/s for the fire truck", "I mean user 4", {"min_rate_bps": {"4": 5e5}}),
    ],
)  # fmt: skip
def test_who_a_stranger_is_is_asked_and_the_request_goes_on(said: str, answer: str, held: dict[str, object]) -> None:
    talk = session()
    assert talk.say(said).stage == "asked"
    assert talk.request is None
    assert talk.say(answer).stage == "applied"
    assert talk.request is not None
    assert dict(talk.request.constraints) == held


def test_two_strangers_are_asked_about_one_after_the_other() -> None:
    talk = session()
    assert "tractor" in talk.say("serve only the tractor and the harvester, max rate").reply
    assert "harvester" in talk.say("user 1").reply
    talk.say("user 2")
    assert talk.request is not None
    assert dict(talk.request.constraints) == {"users": ("1", "2")}
    talk.say("at least 100 kbit/s for the harvester")
    assert dict(talk.request.constraints)["min_rate_bps"] == {"2": 1e5}


@pytest.mark.parametrize(
    "said",
    ["save power for sensors", "the hall is dark, least power", "more speed for video calls", "max rate, says my boss"],
)
def test_a_noun_that_is_nobodys_name_asks_for_nobody(said: str) -> None:
    assert stranger(said, None) == ""


def test_a_user_of_the_cell_is_no_stranger() -> None:
    assert stranger("at least 1 Mbit/s for Brenda", Context(user_names=("Ada", "Brenda"))) == ""
    assert stranger("at least 1 Mbit/s for Brenda", Context(user_names=("Ada", "Bob"))) == "Brenda"
    assert stranger("minimum power for everyone, please", None) == ""


def test_the_guard_stands_behind_a_language_model_too() -> None:
    pytest.importorskip("pydantic_ai")
    said = "If the crowd comes, max total rate"
    filled = {"kind": "allocate", "objective": "max_rate", "objective_words": "max total rate"}
    with StubLlm(lambda _: meaning(**filled)) as stub:
        recogniser = LlmRecogniser(LlmSettings(base_url=stub.url, model="m"))
        first = recogniser.recognise(said)
        talk = session(recogniser=recogniser)
        asked = talk.say(said)
        assert (first.kind, asked.stage) == ("clarify", "asked")
        assert first.guess is not None
        assert first.guess.objective == "max_rate"
        assert talk.say("yes").stage == "applied"
        assert talk.request is not None
        assert talk.request.objective == "max_rate"


_WISHES = ("highest total rate with 10 W", "at least 1 Mbit/s for user 3")
_ELSEWHERE_AND_OTHERS = (
    "provided that finance agrees, {}", "the plan for next quarter is {}", "our investors keep raving about {}",
    "the council would also like {}", "we are not going to ask for {}", "in two hours, {}", "{}, and pigs might fly",
)  # fmt: skip


@pytest.mark.parametrize("wish", _WISHES)
@pytest.mark.parametrize("frame", _ELSEWHERE_AND_OTHERS)
def test_a_wish_in_a_frame_of_others_or_of_later_is_asked_about(frame: str, wish: str) -> None:
    for context in (None, Context(user_names=("a", "b", "c", "d"), objective="max_rate", language="en")):
        intent = recognise(frame.format(wish), context)
        assert intent.kind != "allocate"


@pytest.mark.parametrize(
    ("said", "kind", "value"),
    [("Subcarriers in groups of 4", "resource_block_group_size", 4.0),
     ("子载波四个一组来分", "resource_block_group_size", 4.0),
     ("Asigna las subportadoras en grupos de diez", "resource_block_group_size", 10.0),
     ("Attribuez les sous-porteuses par paquets de six", "resource_block_group_size", 6.0),
     ("Unterträger in Zwölfergruppen vergeben", "resource_block_group_size", 12.0),
     ("no more than 250 mW on any one subcarrier", "subcarrier_max_power_w", 0.25),
     ("Pro Unterträger bitte maximal 250 mW", "subcarrier_max_power_w", 0.25),
     ("Stay below 8 watts at all times, will you?", "max_power_w", 8.0),
     ("Keep the total radiated power to 14 watts, would you?", "max_power_w", 14.0)],
)  # fmt: skip
def test_a_bare_limit_amends_the_request_that_holds(said: str, kind: str, value: float) -> None:
    held = Context(user_names=("a", "b", "c", "d"), objective="max_rate", language="en")
    intent = recognise(said, held)
    assert (intent.kind, intent.objective, dict(intent.constraints)) == ("allocate", "max_rate", {kind: value})


@pytest.mark.parametrize(
    "said",
    ["the landlord is after minimum power", "the pump station should run at minimum power",
     "operations has its heart set on energy efficiency", "the kids would rather have max throughput",
     "der Vermieter ist auf minimale Leistung aus", "die Nachtschicht hat die Zelle auf maximalen Durchsatz gestellt",
     "el casero anda buscando la mínima potencia", "la station de pompage doit tourner à puissance minimale",
     "财务想要更低的功率", "泵站要以最小功率运行", "maximum throughput is the last thing we need"],
)  # fmt: skip
def test_an_aim_that_is_told_of_somebody_else_is_asked_about(said: str) -> None:
    assert recognise(said, Context(user_names=USERS)).kind == "clarify"


@pytest.mark.parametrize(
    "said",
    ["If it isn't too much hassle, would you go for the maximum total rate?",
     "Quisiera, si no es molestia, la potencia más baja con medio mega por usuario.",
     "J'aimerais, si ça ne dérange pas, la puissance la plus basse avec 500 kbit/s par utilisateur.",
     "Wenn's keine Umstände macht, die kleinste Leistung bei einem halben Megabit pro Nutzer.",
     "No one above 4 Mbit/s please, the backhaul microwave link chokes, otherwise full speed.",
     "El jefe está aquí mirando, enséñale lo máximo que da la celda en total.",
     "电费太贵了，老板天天念叨，请按能效最高来跑。",
     "Laisse tomber l'utilisateur 3 qui n'a pas payé et pousse le débit total avec 12 W maximum.",
     "My internet is too slow"],
)  # fmt: skip
def test_courtesy_and_a_story_beside_a_wish_ask_nothing(said: str) -> None:
    assert recognise(said, Context(user_names=USERS)).kind == "allocate"


@pytest.mark.parametrize(
    "said", ["the night shift ran 5 W", "My cousin's shop makes do with 5 W", "Eight watts melted the old amplifier"]
)
def test_a_figure_that_is_only_told_changes_nothing(said: str) -> None:
    now = Context(user_names=("user 1", "user 2"), objective="max_rate", language="en")
    asked = recognise(said, now)
    assert asked.kind == "clarify"
    assert not asked.pending
    assert not (asked.guess and asked.guess.constraints)
    assert recognise("run it at 5 W", now).constraints == {"max_power_w": 5.0}


def test_a_word_of_condition_asks_nothing_in_what_is_an_order() -> None:
    said = "Would you, if that fits, please keep it below 7 W"
    now = Context(user_names=("user 1", "user 2"), objective="max_rate", language="en")
    assert recognise(said, now).constraints == {"max_power_w": 7.0}


@pytest.mark.parametrize(
    ("said", "against"),
    [
        ("Maximize the total rate, no way user 3 gets 5 Mbit/s", "no way user 3 gets 5 Mbit/s"),
        ("max rate, nobody wants user 3 to get 5 Mbit/s", ""),
    ],
)
def test_what_a_sentence_goes_on_with_has_to_be_an_order_too(said: str, against: str) -> None:
    intent = understood(said, Context(user_names=USERS), OfflineRecogniser())
    assert (intent.kind, intent.guess is not None) == ("clarify", True)
    assert not against or f"“{against}”" in intent.reply


def test_a_clause_that_orders_stands_beside_others() -> None:
    said = "max rate, at most 10 W, user 3 at least 1 Mbit/s and user 4 at most 2 Mbit/s"
    assert understood(said, Context(user_names=USERS), OfflineRecogniser()).kind == "allocate"


@pytest.mark.parametrize(
    "said",
    [
        "highest rate, ignore the 10 W limit",
        "leave out all but users 3 and 4, max rate",
        "总速率最大，取消10瓦的限制",
    ],
)
def test_what_is_read_amiss_is_asked_about_with_what_was_read(said: str) -> None:
    intent = understood(said, Context(user_names=USERS), OfflineRecogniser())
    assert intent.kind == "clarify"
    assert intent.guess is not None
    assert intent.guess.constraints


def test_a_mistyped_sentence_is_not_judged_by_what_is_left_of_it() -> None:
    assert Sentence("max rate, ignore the 10 W limit", own_words()).fidelity < 0.2
    assert Sentence("max rate, ignnoer teh 10 W limmit", own_words()).fidelity == 1


def test_a_meaning_that_the_words_alone_do_not_have_is_not_judged_by_them() -> None:
    said, context = "max rate, at most 15 W less", Context(user_names=USERS)
    read = OfflineRecogniser().read(said, context)
    assert is_bent(said, context, read)
    assert not is_bent(said, context, dataclasses.replace(read, constraints={"max_power_w": 5.0}))
