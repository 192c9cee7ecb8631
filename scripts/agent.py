"""A scripted agent: it works through `diorama mcp` with the SDK's own client, as an agent's program does.

    python scripts/agent.py session --out docs/agents-session.md --pictures docs/images
    python scripts/agent.py prompts [--scenes N]      # the 64 prompts of `bench text`, each built and checked
    python scripts/agent.py sentences                 # the sentences of the tests, each done, judged and undone

`session` turns the example's picture into a tidied, exported room and writes down what was called and answered.
"""

from __future__ import annotations

import argparse
import base64
import io
import json
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import anyio
from mcp import Client
from mcp.client.stdio import StdioServerParameters
from PIL import Image

from diorama_app.projects.begin import begin_with_scene
from diorama_app.projects.example import EXAMPLE
from diorama_core.evaluation.benchmarks import text as bench
from diorama_core.evaluation.benchmarks.text import Measured, TextBench
from diorama_core.evaluation.metrics.text_scene import measure
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.schema import scene_from_json
from diorama_core.scene.types import Scene

ROOT = Path(__file__).resolve().parents[1]
QUALITY = 82
SHOWN_CHARS = 300
"""Of an answer in the written session."""


class Agent:
    """Calls tools and remembers what was said."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.log: list[str] = []
        self.pictures: list[bytes] = []

    async def call(self, tool: str, **arguments: Any) -> Any:
        """What a tool answers; a refusal is raised."""
        begun = time.perf_counter()
        result = await self._client.call_tool(tool, arguments)
        took = time.perf_counter() - begun
        first = result.content[0] if result.content else None
        said = json.dumps(arguments, ensure_ascii=False)
        self.log.append(f"**{tool}** `{said if len(said) <= SHOWN_CHARS else said[:SHOWN_CHARS] + '…'}` ({took:.1f} s)")
        if result.is_error:
            self.log.append(f"> refused: {first.text}")
            raise ValueError(first.text)
        if first is not None and first.type == "image":
            self.pictures.append(base64.b64decode(first.data))
            return None
        return result.structured_content

    def say(self, words: str) -> None:
        """Write down what the agent makes of an answer."""
        self.log.append(f"> {words}")

    async def scene(self) -> Scene:
        """The open room's scene."""
        return scene_from_json((await self._client.read_resource("diorama://scene")).contents[0].text)


def server(home: Path, *arguments: str) -> StdioServerParameters:
    """`diorama mcp` with a home of its own, so that nothing of the person's is touched."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("XDG_")}
    environment = {**kept, "HOME": str(home), "PYTHONPATH": str(ROOT)}
    (home / "Diorama").mkdir(exist_ok=True)
    command = ["-m", "diorama_app.cli", "mcp", *arguments]
    return StdioServerParameters(command=sys.executable, args=command, env=environment, cwd=ROOT)


async def session(home: Path, out: Path, pictures: Path) -> None:
    """From the example's picture to a tidied, exported room, written down."""
    async with Client(server(home), read_timeout_seconds=600.0) as client:
        agent = Agent(client)
        boxes = json.loads((EXAMPLE / "boxes.json").read_text())["boxes"]
        room = await agent.call("build", photo=str(EXAMPLE / "photo.jpg"), boxes=boxes)
        agent.say(f"{len(room['objects'])} objects; {room['room'][0]['role']} and {len(room['room']) - 1} other planes")
        await agent.call("look", view="photo")
        before = await agent.call("check")
        agent.say("; ".join(before["lines"][:6]) or "nothing is wrong")
        doubts = await agent.call("ask", about="doubts")
        agent.say("; ".join(f"{i}: {words[0]}" for i, words in list(doubts["objects"].items())[:4]) or "no doubts")
        first = next(o["id"] for o in room["objects"] if o["category"] == "armchair")
        around = await agent.call("ask", about="one object", object_id=first)
        nearest = next(iter(around["gaps_m"].items()))
        agent.say(f"{first} is {nearest[1]} m from {nearest[0]}")
        free = await agent.call("ask", about="free floor", width_m=0.6, depth_m=0.6)
        agent.say(f"{free['free_m2']} m² are free; a place of 0.6 m is at {free['spots'][0]}")
        insert = {"do": "insert", "what": "floor lamp", "places": [{"relation": "beside", "targets": [first]}]}
        turn = {"do": "turn", "objects": [first], "degrees": 20}
        done = await agent.call("edit", edits=[insert, turn])
        agent.say("; ".join(done["lines"] + done["notes"]))
        done = await agent.call("edit", words="paint the wall behind the sofa sage")
        agent.say("; ".join(done["lines"]))
        await agent.call("optimise")
        for object_id in (after := await agent.call("check"))["problems"]:
            held_by = next(o["held_by"] for o in room["objects"] if o["id"] == object_id)
            if held_by not in after["problems"]:
                agent.say(f"{object_id}: {' and '.join(after['problems'][object_id])}; to be moved beside the sofa")
                beside = {"relation": "beside", "targets": ["sofa_1"]}
                await agent.call("edit", edits=[{"do": "move", "objects": [object_id], "places": [beside]}])
        after = await agent.call("check")
        agent.say(f"collisions {len(before['collisions'])} -> {len(after['collisions'])}, objects with problems "
                  f"{len(before['problems'])} -> {len(after['problems'])}, walkways {after['walkways']}")  # fmt: skip
        await agent.call("look", view="orbit:20", ids=False)
        await agent.call("undo")
        await agent.call("redo")
        file = await agent.call("export", path=str(home / "room.glb"), format="glb")
        agent.say(f"{file['bytes'] / 1e6:.1f} MB")
    home_name = str(home)
    out.write_text("\n\n".join(line.replace(home_name, "~").replace(str(ROOT), ".") for line in agent.log) + "\n")
    for name, content in zip(("agent-ids.jpg", "agent-room.jpg"), agent.pictures, strict=True):
        Image.open(io.BytesIO(content)).save(pictures / name, quality=QUALITY)


async def prompts(home: Path, scenes: int) -> TextBench:
    """The prompts of the text benchmark, each built and checked by the agent."""
    library, found = built_in_library(), list[Measured]()
    asked = [(series, one) for series in bench.SERIES for one in bench.prompts_of(series)][:scenes]
    async with Client(server(home), read_timeout_seconds=600.0) as client:
        for series, one in asked:
            agent, begun = Agent(client), time.perf_counter()
            room = await agent.call("build", text=one.prompt)
            await agent.call("check")
            seconds = time.perf_counter() - begun
            found.append(
                Measured(
                    series, one.prompt, measure(one, await agent.scene(), library), tuple(room["notes"][1:]), seconds
                )
            )
            print(f"{len(found)} of {len(asked)}: {seconds:.1f} s", file=sys.stderr)
    return TextBench(0, tuple(found))


async def sentences(home: Path) -> Sequence[tuple[str, str]]:
    """The sentences of the tests, each done through the tools, judged by its own check, and undone."""
    from tests.text.edited import dining_room, living_room
    from tests.text.test_natural_sentences import MORE, NATURAL, REFUSED, REPORTED

    rooms = {"living": living_room(), "dining": dining_room()}
    for name, scene in rooms.items():
        begin_with_scene(home / "Diorama", name, scene, {}, (), built_in_library())
    verdicts = []
    async with Client(server(home), read_timeout_seconds=600.0) as client:
        for sentence, holds in {**NATURAL, **REPORTED, **MORE}.items():
            agent, name = Agent(client), "dining" if "chairs" in sentence else "living"
            await agent.call("open_room", project=name)
            before = await agent.scene()
            try:
                await agent.call("edit", words=sentence)
                verdict = "done" if holds(await agent.scene(), before) else "otherwise"
                if await agent.scene() != before:
                    await agent.call("undo")
                verdict += "" if await agent.scene() == before else ", not undone"
            except ValueError as error:
                verdict = "refused, as the tests expect" if sentence in REFUSED else f"refused: {error}"
            verdicts.append((sentence, verdict))
            print(f"{sentence}: {verdict}", file=sys.stderr)
    return verdicts


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("what", choices=("session", "prompts", "sentences"))
    parser.add_argument("--out", type=Path, default=Path("agents-session.md"))
    parser.add_argument("--pictures", type=Path, default=Path())
    parser.add_argument("--scenes", type=int, default=64)
    a = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="diorama-agent-") as folder:
        if a.what == "session":
            anyio.run(session, Path(folder), a.out, a.pictures)
        elif a.what == "prompts":
            for table in anyio.run(prompts, Path(folder), a.scenes).tables():
                print(table.to_markdown())
        else:
            verdicts = anyio.run(sentences, Path(folder))
            counts = {v: sum(v == other for _, other in verdicts) for _, v in verdicts}
            print(json.dumps({"sentences": len(verdicts), **counts}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
