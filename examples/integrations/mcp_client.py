"""A conversation over MCP: a wish, a look at what would change, a yes of your own.

python examples/integrations/mcp_client.py "Save power, at least 1 Mbit/s each"

It starts a server of its own; give WIRELESSAGENT_MCP_URL (as http://127.0.0.1:8642/mcp) to talk to one that runs.
"""

from __future__ import annotations

import asyncio
import os
import sys

from mcp import Client
from mcp.client.stdio import StdioServerParameters


async def converse(wish: str) -> None:
    server = os.environ.get("WIRELESSAGENT_MCP_URL") or StdioServerParameters(
        command=sys.executable, args=["-m", "wirelessagent", "mcp"], env=dict(os.environ)
    )
    async with Client(server) as client:
        said = await client.call_tool("say", {"text": wish})
        print(said.content[0].text)
        plan = (said.structured_content or {}).get("plan")
        if plan is not None and input("Apply it? ").strip().lower() in ("y", "yes"):
            applied = await client.call_tool("apply", {"plan": plan["id"]})
            print(applied.content[0].text)


if __name__ == "__main__":
    asyncio.run(converse(" ".join(sys.argv[1:]) or "how sure is this?"))
