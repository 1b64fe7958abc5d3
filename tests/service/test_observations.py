"""Files that were sent and files that were made are kept in one way: room is made, and none may be too large."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from wirelessagent.service.limits import Limits
from wirelessagent.service.observations import Observations
from wirelessagent.service.problems import ConflictError, NotFoundError, TooMuchError, UnusableError
from wirelessagent.service.service import Service
from wirelessagent.service.workers import Workers
from wirelessagent.store.ledger import Ledger


class _Worker(Workers):
    """Finds as many users in each file as it has bytes."""

    def __init__(self) -> None:
        """Nothing is started."""

    async def do(self, what: str, tell: Any, **told: Any) -> Any:
        if what == "operation":
            Path(told["out"]).write_bytes(b"x" * told["form"]["size"])
            return {"record": {}, "blocks": []}
        seen = len(Path(told["channel"]).read_bytes())
        return {"num_users": seen, "num_subcarriers": 1, "called": told["called"]}


@pytest.fixture
def ledger(tmp_path: Path) -> Iterator[Ledger]:
    ledger = Ledger.open(tmp_path / "store.sqlite3")
    yield ledger
    ledger.close()


@pytest.fixture
def kept(ledger: Ledger, tmp_path: Path) -> Observations:
    return Observations(ledger, tmp_path / "files", _Worker(), Limits(observations=2, gains=10))


def _add(kept: Observations, size: int = 1) -> str:
    return asyncio.run(kept.add("a.csv", b"x" * size, {}, lambda _: None))["id"]


def _derive(kept: Observations, size: int = 1) -> str:
    return asyncio.run(kept.derive("simulate", {"size": size}, lambda _: None))["observation"]["id"]


def test_room_is_made_of_what_was_derived_and_nobody_uses(kept: Observations, ledger: Ledger) -> None:
    first, second = _derive(kept), _derive(kept)
    ledger.put("cell", "c", {"name": "c", "observation": first})
    sent = _add(kept)
    assert {item.id for item in ledger.all("observation")} == {first, sent}
    assert second not in (first, sent)
    for keep in (_add, _derive):
        with pytest.raises(TooMuchError):
            keep(kept)


def test_what_is_too_large_is_not_kept(kept: Observations, ledger: Ledger, tmp_path: Path) -> None:
    for keep in (_add, _derive):
        with pytest.raises(UnusableError, match="at most 10 gains"):
            keep(kept, 11)
    assert ledger.all("observation") == []
    assert list((tmp_path / "files").iterdir()) == []


def test_a_cell_that_is_made_while_its_observation_is_removed(
    kept: Observations, ledger: Ledger, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent, drop = _add(kept), ledger.drop

    def dropped(kind: str, id: str, **more: Any) -> bool:
        ledger.put("cell", "c", {"name": "c", "observation": sent})
        return drop(kind, id, **more)

    monkeypatch.setattr(ledger, "drop", dropped)
    with pytest.raises(ConflictError, match="'c' works on this observation"):
        asyncio.run(kept.drop(sent))
    assert ledger.find("observation", sent) is not None


def test_a_cell_that_moves_to_an_observation_while_that_is_removed(ledger: Ledger, tmp_path: Path) -> None:
    workers: Any = _Worker()
    service = Service(ledger, tmp_path / "files", workers, Limits())
    sent, put = _add(service.observations), ledger.put
    held = {"name": "c", "observation": None, "options": {}, "session": "s", "demonstration": False}
    ledger.put("cell", "c", held)

    def removed(kind: str, id: str, data: Any, **more: Any) -> int:
        if kind == "cell":
            ledger.drop("observation", sent)
        return put(kind, id, data, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ledger, "put", removed)
        with pytest.raises(NotFoundError):
            asyncio.run(service.move_cell("c", sent, lambda _: None))
    item = ledger.find("cell", "c")
    assert item is not None
    assert (item.data["observation"], item.data["session"]) == (None, "s")


def test_many_files_at_once(ledger: Ledger, tmp_path: Path) -> None:
    kept = Observations(ledger, tmp_path / "files", _Worker(), Limits(observations=500))

    async def send() -> None:
        await asyncio.gather(*(kept.add("a.csv", b"x", {}, lambda _: None) for _ in range(200)))

    asyncio.run(send())
    assert len(ledger.all("observation")) == 200
