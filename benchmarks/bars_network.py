"""A small network as the judge of sentences, against the shipped linear models: kinds told right, frames acted upon.

Run with ``uv run --with jax --with optax python benchmarks/bars_network.py FILE.jsonl … [--weights FILE.npz]``; files
are those of ``bars_frames.py`` and of ``wirelessagent evaluate intents``. The network is taught from scratch (35
minutes on two cores) where there are no weights yet, by all that the shipped models learn from and by the sentences of
``network/taught``, which those have not learned. Printed are the sentences whose likeliest kind or aim is right, and
for those that say whether they act the orders that are not likely enough and the others that are, by the judge alone.
"""

from __future__ import annotations

import argparse
import dataclasses
import logging
import random
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from bars_frames import read
from network.fit import LENGTHS, PASSES, Shown, fit
from network.judge import KNOWN, TOLD, SentenceModel, hashes_of, rows_of, words_of

from wirelessagent.language.linear_model import shipped_model
from wirelessagent.language.order_model import frame_of, shipped_order_model
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.training import orders
from wirelessagent.language.training.compose import OBJECTIVES, mistyped, sentences
from wirelessagent.language.training.fit import in_parallel
from wirelessagent.language.training.spoken import spoken

TAUGHT = Path(__file__).with_name("network") / "taught"
TRAINING = Path(orders.__file__).parent
DRAWN, NEAR, FILLING = 0.5, 0.3, 0.5
"""What the kind of a drawn aim counts, of a sentence that only orders or does not, and of the wish in a frame that
orders it, beside one that is known."""
SLIPS = 0.15
"""How much of what people wrote of aims is read with a slip as well."""
ASKED = ("?", "？", "吗")
"""How most questions end."""
_ORDERS = (*OBJECTIVES, "clarify.limits", "command")
_RARE, _LEAST, _MOST = -0.2, 0.5, 3.0
OFTEN = 6
"""How often something has to be seen to be known: else it falls into the bucket of anything else."""


def examples() -> list[tuple[str, str, float, bool, float, float]]:
    """Sentences with their kind and how much it counts, whether they order and how much that counts, and how often."""
    found = list[tuple[str, str, float, bool, float, float]]()
    for text, label in sorted(set(sentences(TRAINING))):
        aim, tells = label in OBJECTIVES, label.startswith(("command", "question"))
        found.append((text, label, DRAWN if aim else 1.0, label.startswith("command"), orders.MILD if tells else 0.0,
                      0.3 if aim else 0.6))  # fmt: skip
    slips = random.Random(1)
    own = (dataclasses.replace(each, near=each.label in ("order", "none")) for each in spoken(TAUGHT))
    for each in (*spoken(), *own):
        kind = "clarify.limits" if each.label == "clarify" and each.constraints else each.label
        doubts = kind == "clarify" and Sentence(each.text, own_words()).reading.doubts
        counts = 0.0 if doubts else NEAR if kind in ("order", "none") else 1.0
        kind = _nothing(each.text) if kind == "none" else kind
        does = True if kind.startswith("command") else each.is_order
        tells = 0.0 if does is None else 1.0 if each.near else orders.MILD
        teaches = (kind, counts, bool(does), tells, 1.0)
        found.append((each.text, *teaches))
        if kind in OBJECTIVES and slips.random() < SLIPS:
            found.append((mistyped(each.text, slips), *teaches))
    for text, does, kind in orders.framed():
        taught_kind, counts = (kind, FILLING) if does else (_nothing(text), NEAR)
        found.append((text, taught_kind, counts, does, orders.FRAME / orders.FILLED, 0.5))
    return found + [(text, "", 0.0, does, orders.TALK, 0.5) for text, does in orders.in_talks()]


def _nothing(text: str) -> str:
    """The kind of what orders nothing: most of it tells of an aim, some asks."""
    return "none" if text.rstrip(" .。!！").endswith(ASKED) else TOLD


def seen(text: str) -> tuple[Any, Any]:
    """What is seen of a sentence, and of one whose wish is left with what it means alone."""
    words = words_of(Sentence(text, own_words()))[: LENGTHS[-1]]
    return hashes_of(words), hashes_of(words, bare=True)


def taught(every: list[tuple[str, str, float, bool, float, float]], passes: float = PASSES) -> SentenceModel:
    """The network, taught by these sentences."""
    shown = in_parallel(seen, [text for text, *_ in every])
    found, times = np.unique(np.concatenate([hashes for (hashes, _), _ in shown]), return_counts=True)
    known = np.zeros(KNOWN, np.bool_)
    known[found[times >= OFTEN] % KNOWN] = True
    kinds = [kind for _, kind, *_ in every]
    labels = sorted({kind for kind in kinds if "." in kind or kind in (*OBJECTIVES, "out_of_scope")})
    meant = {kind: [bool(kind) and f"{label}.".startswith(f"{kind}.") for label in labels] for kind in set(kinds)}
    meant["order"] = [label.startswith(_ORDERS) for label in labels]
    meant["none"] = [not each for each in meant["order"]]
    right, counts = np.array([meant[kind] for kind in kinds]), np.array([each[2] for each in every], np.float32)
    even = right / np.maximum(1, right.sum(axis=1, keepdims=True))
    share = even @ (counts @ even / counts.sum())
    rare = np.where(counts > 0, (len(labels) * np.maximum(share, 1e-6)) ** _RARE, 0)
    weights = fit(Shown(
        rows=[rows_of(*said, known) for said, _ in shown], bare=[rows_of(*bare, known) for _, bare in shown],
        right=right,
        kind_counts=counts * np.clip(rare / rare[counts > 0].mean(), _LEAST, _MOST).astype(np.float32),
        orders=np.array([each[3] for each in every], np.float32),
        order_counts=np.array([each[4] for each in every], np.float32), turns=np.array([each[5] for each in every]),
    ), passes)  # fmt: skip
    return SentenceModel(labels=tuple(labels), weights=weights, known=known)


def best_kind(chances: Any) -> str:
    """The likeliest aim or kind of all its topics together."""
    sums = Counter[str]()
    for label, chance in chances.items():
        sums[label if label in OBJECTIVES else label.partition(".")[0]] += chance
    return max(sums, key=lambda kind: sums[kind])


def main() -> None:
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    parser = argparse.ArgumentParser(description="A network as the judge of sentences, against the linear models.")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--weights", type=Path, default=Path("network.npz"))
    given = parser.parse_args()
    if not given.weights.exists():
        taught(examples()).save(given.weights)
    network = SentenceModel.load(given.weights)
    print(f"{'':40}{'network':>24}{'linear':>24}")
    for path in given.files:
        rows = read(path)
        told, acted, asked = Counter[str](), Counter[str](), Counter[str]()
        for row in rows:
            sentence = Sentence(row["text"], own_words())
            judged, frame = network.chances(words_of(sentence)), frame_of(sentence)
            linear = shipped_model().probabilities(*sentence.for_model())
            wanted = row["objective"] if row["act"] and row.get("objective") else row.get("kind")
            sure = {"network": judged.is_order, "linear": shipped_order_model().is_order(frame)}
            for judge, kinds in (("network", judged.kinds), ("linear", linear)):
                told[judge] += best_kind(kinds) == wanted
                acted[judge] += sure[judge] and not row["act"]
                asked[judge] += row["act"] and not sure[judge]
        orders_there, known = (
            sum(row["act"] for row in rows),
            sum("kind" in row or bool(row["objective"]) for row in rows),
        )
        for name, counted, of in (
            ("kinds right", told, known), ("no orders, likely enough", acted, len(rows) - orders_there),
            ("orders, not likely enough", asked, orders_there),
        ):  # fmt: skip
            shares = (f"{counted[judge]} of {of}" for judge in ("network", "linear"))
            print(f"{path.stem[:14]:15}{name:25}" + "".join(f"{share:>24}" for share in shares))


if __name__ == "__main__":
    main()
