"""The service under load: requests a second and latency beside a bare FastAPI endpoint, memory, health while it works.

    python benchmarks/bars_service.py [--seconds 60] [--clients 32]

70 % of the requests read, 20 % solve 8×20, 10 % say a line. The bare endpoint runs in the same way, one after the
other with the server's ``/healthz``.
"""

from __future__ import annotations

import argparse
import asyncio
import collections
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import httpx2
import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))

from servers import Server, started

_BARE = """
import uvicorn
from fastapi import FastAPI
app = FastAPI()
@app.get("/healthz")
async def healthy(): return {"status": "ok"}
uvicorn.run(app, port=%d, log_level="warning", access_log=False)
"""


async def timed(client: httpx2.AsyncClient, times: list[float], bad: list[str], *request: Any, **more: Any) -> Any:
    began = time.perf_counter()
    answer = await client.request(*request, **more)
    times.append(time.perf_counter() - began)
    if answer.status_code >= 400:
        bad.append(f"{request} {answer.status_code} {answer.text[:200]}")
    return answer


async def flood(url: str, path: str, seconds: float, clients: int) -> tuple[float, list[float]]:
    """Requests a second for one path, and their times."""
    times, bad, until = list[float](), list[str](), time.perf_counter() + seconds

    async def one() -> None:
        async with httpx2.AsyncClient(base_url=url, trust_env=False) as client:
            while time.perf_counter() < until:
                await timed(client, times, bad, "GET", path)

    await asyncio.gather(*(one() for _ in range(clients)))
    assert not bad, bad[:3]
    return len(times) / seconds, times


async def mixed(server: Server, seconds: float, clients: int) -> dict[str, list[float]]:
    """70 % reads, 20 % solves, 10 % lines, by so many clients with a cell each."""
    gains = np.random.default_rng(1).exponential(1e-10, (8, 20))
    content = "\n".join(",".join(f"{gain:.4g}" for gain in row) for row in gains)
    times, bad = collections.defaultdict[str, list[float]](list), list[str]()
    until = time.perf_counter() + seconds

    async def one(seed: int) -> None:
        draw = random.Random(seed)
        async with httpx2.AsyncClient(base_url=server.url, trust_env=False, timeout=120) as client:
            headers = {"Content-Type": "application/octet-stream"}
            seen = (await client.post("v1/observations?name=g.csv", content=content, headers=headers)).json()["id"]
            cell = (await client.post("v1/cells", json={"name": str(seed), "options": {"seed": seed}})).json()
            session = cell["session"]
            while time.perf_counter() < until:
                share = draw.random()
                if share < 0.7:
                    path = draw.choice([f"v1/sessions/{session}", "v1/cells", "healthz", f"v1/cells/{cell['id']}"])
                    await timed(client, times["read"], bad, "GET", path)
                elif share < 0.9:
                    body = {"observation": seen, "objective": "max_rate"}
                    await timed(client, times["solve"], bad, "POST", "v1/operations/solve", json=body)
                else:
                    line = draw.choice(["highest total rate", "at most 10 W", "how sure is this?", "start over"])
                    await timed(client, times["say"], bad, "POST", f"v1/sessions/{session}/turns", json={"text": line})

    await asyncio.gather(*(one(seed) for seed in range(clients)))
    assert not bad, (len(bad), bad[:3])
    return times


async def health_at_work(server: Server) -> list[float]:
    """Times of ``/healthz`` while 64×273 is solved thoroughly."""
    gains = np.random.default_rng(2).exponential(1e-10, (64, 273))
    content = "\n".join(",".join(f"{gain:.4g}" for gain in row) for row in gains)
    times, bad = list[float](), list[str]()
    async with httpx2.AsyncClient(base_url=server.url, trust_env=False, timeout=120) as client:
        headers = {"Content-Type": "application/octet-stream"}
        seen = (await client.post("v1/observations?name=g.csv", content=content, headers=headers)).json()["id"]
        form = {"observation": seen, "objective": "max_min_rate", "method": "dual",
                "method_options": {"effort": "thorough", "deadline_ms": 5000.0}}  # fmt: skip
        solving = asyncio.create_task(client.post("v1/operations/solve", json=form))
        while not solving.done():
            await timed(client, times, bad, "GET", "healthz")
            await asyncio.sleep(0.02)
        assert (await solving).status_code == 200, (await solving).text[:300]
    return times


def told(name: str, times: list[float], seconds: float) -> None:
    p50, p99 = (1000 * float(np.percentile(times, share)) for share in (50, 99))
    print(f"  {name:24s} {len(times) / seconds:8.1f} /s   p50 {p50:8.1f} ms   p99 {p99:8.1f} ms   ({len(times)})")


def resident_kib(process: int) -> int:
    for line in Path(f"/proc/{process}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1])
    return 0


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--clients", type=int, default=32)
    given = parser.parse_args()
    port = 8699
    bare = subprocess.Popen([sys.executable, "-c", _BARE % port], stdout=subprocess.DEVNULL)
    with (
        tempfile.TemporaryDirectory() as folder,
        started(Path(folder) / "a.db", "--requests-per-s", "1000000") as server,
    ):
        time.sleep(3)
        print("\nHealth beside a bare FastAPI endpoint")
        peer, times = asyncio.run(flood(f"http://127.0.0.1:{port}", "/healthz", 8, 8))
        told("bare FastAPI", times, 8)
        ours, times = asyncio.run(flood(server.url, "healthz", 8, 8))
        told("this server", times, 8)
        print(f"  ratio {ours / peer:.2f} (bar 0.5)")
        bare.kill()
        asyncio.run(flood(server.url, "v1/cells", 1000 / max(ours, 1), 8))
        before = resident_kib(server.process.pid)
        asyncio.run(flood(server.url, "v1/cells", 9000 / max(ours, 1), 8))
        grown = resident_kib(server.process.pid) / before - 1
        print(f"\nMemory from about request 1,000 to 10,000: {100 * grown:+.1f} % (bar 5 %)")
        print(f"\nMixed load, {given.clients} clients, {given.seconds:g} s; no request failed")
        for name, found in asyncio.run(mixed(server, given.seconds, given.clients)).items():
            told(name, found, given.seconds)
        print("\nHealth while 64×273 is solved thoroughly (bar: p99 50 ms)")
        told("healthz", asyncio.run(health_at_work(server)), 1)


if __name__ == "__main__":
    main()
