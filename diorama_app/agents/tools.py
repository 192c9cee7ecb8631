"""The tools of an agent: it builds, looks, asks, edits, optimises, checks, undoes and exports, a room at a time."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

import anyio
from mcp.server.mcpserver import Context, Image
from pydantic import Field, TypeAdapter

from diorama_app.agents.api import Api
from diorama_core.errors import InputError
from diorama_core.io.atomic import write_atomically
from diorama_core.scene.schema import scene_file_schema
from diorama_core.text.edit_plan import Edit, TypedEdit

AUTHOR = "Agent"
STEP_S = 1.0
"""How often long work is reported on."""
VIEW = Field(
    description="photo, top, front, orbit:DEG (around from outside) or look:X,Y,Z:X,Y,Z (from a point toward another)"
)
INSTRUCTIONS = """Rooms that are open in Diorama's editor. A person may have the same room in a browser, and sees every
step. Begin with `rooms` and `open_room`, or with `build`. `look` shows pictures with the objects' ids; `ask` tells
sizes, places, distances, free floor, supports and doubts; `questions` tells what to look at first, and `answer` settles
it; `edit` changes them; `check` says whether people could use the room. Lengths are metres, +Z is up, headings are
degrees counter-clockwise from +X. An error says what to do. Where somebody has changed the room meanwhile, look or ask
again first."""


class Tools:
    """What an agent can do. One room is open at a time."""

    def __init__(self, api: Api, project: str | None) -> None:
        """Begin with a room, or with none.

        Args:
            api: of the editor.
            project: name of the room's folder.
        """
        self._api, self._project = api, project
        self._version = ""
        """Version of the room that the agent has seen last."""

    def all(self) -> tuple[Callable[..., Any], ...]:
        """The tools, by the names of their methods."""
        return (
            *(self.rooms, self.open_room, self.build, self.look, self.ask),
            *(self.questions, self.answer),
            *(self.edit, self.optimise, self.check, self.undo, self.redo, self.export),
        )

    def rooms(self) -> dict[str, Any]:
        """All rooms that there are; `open_room` takes the name under `project`."""
        answer: dict[str, Any] = self._api.get("v1/projects")
        return answer

    def open_room(self, project: str) -> dict[str, Any]:
        """Open a room: its objects, its planes, what is doubtful, and the page where a person sees it."""
        return self._remember(self._api.get(f"v1/projects/{project}"))

    async def build(
        self,
        ctx: Context,
        photo: Annotated[str, Field(description="Path of a photo on this machine.")] = "",
        boxes: Annotated[
            list[dict[str, Any]],
            Field(description='Furniture in the photo, in pixels: [{"bbox": [x1, y1, x2, y2], "class": "chair"}].'),
        ] = [],  # noqa: B006  # a default of the tool's schema, never changed
        text: Annotated[str, Field(description="Or a room in words, instead of a photo.")] = "",
        depth: Annotated[str, Field(description="Path of a measured depth map, if there is one.")] = "",
        fov_deg: Annotated[float | None, Field(description="The photo's horizontal field of view, if known.")] = None,
    ) -> dict[str, Any]:
        """Build a new room from a photo or from words, and open it. Takes seconds to a minute."""
        if bool(photo) == bool(text):
            raise InputError("give either a photo or a text")
        if text:
            body = {"text": text, "author": AUTHOR}
            return self._remember(await anyio.to_thread.run_sync(lambda: self._api.post("v1/projects/described", body)))
        fields = {"author": AUTHOR}
        fields |= {"boxes": json.dumps(boxes)} if boxes else {}
        fields |= {"fov_deg": str(fov_deg)} if fov_deg is not None else {}
        files = {"depth": Path(depth).expanduser()} if depth else {}
        path = Path(photo).expanduser()
        begun = await anyio.to_thread.run_sync(lambda: self._api.send_photo("v1/projects", path, fields, files))
        self._project = begun["project"]
        await self._outcome(ctx)
        return await anyio.to_thread.run_sync(lambda: self.open_room(self._room))

    def look(
        self,
        view: Annotated[str, VIEW] = "photo",
        ids: Annotated[bool, Field(description="Whether objects are outlined and named by their ids.")] = True,
        width: Annotated[int, Field(ge=64, le=2048)] = 896,
        height: Annotated[int, Field(ge=64, le=2048)] = 672,
    ) -> Image:
        """A picture of the open room as it is now, from any view."""
        self._remember(self._api.get(self._path()))
        return Image(
            data=self._api.content(self._path("/picture"), view=view, ids=ids, width=width, height=height), format="png"
        )

    def ask(
        self,
        about: Annotated[
            Literal["room", "one object", "free floor", "doubts"],
            Field(description="the whole room; one object with distances and alternatives; places; what is unsure"),
        ] = "room",
        object_id: Annotated[str, Field(description="Of the object that is asked about.")] = "",
        width_m: Annotated[float, Field(gt=0, le=50, description="Of what is to find a free place.")] = 1.0,
        depth_m: Annotated[float, Field(gt=0, le=50)] = 1.0,
    ) -> dict[str, Any]:
        """Sizes, places, headings, supports, distances, free floor, and what the build was not sure of."""
        scene = self._remember(self._api.get(self._path()))
        if about == "free floor":
            free: dict[str, Any] = self._api.get(self._path("/free-floor"), width_m=width_m, depth_m=depth_m)
            return free
        if about == "one object":
            if not object_id:
                raise InputError("name the object: object_id, as `look` shows it")
            detail: dict[str, Any] = self._api.get(self._path(f"/objects/{object_id}"))
            return detail
        if about == "doubts":
            doubtful = {o["id"]: o["doubts"] + o["problems"] for o in scene["objects"]}
            return {"objects": {i: words for i, words in doubtful.items() if words}, "notes": scene["notes"]}
        return scene

    def edit(
        self,
        edits: Annotated[list[TypedEdit], Field(description="Typed edits, done in order, all or none.")] = [],  # noqa: B006
        words: Annotated[str, Field(description="Or a command in plain English, instead of edits.")] = "",
    ) -> dict[str, Any]:
        """Change the open room: one step, which the person sees and one undo takes back."""
        self._need_seen()
        given = TypeAdapter(list[Edit]).dump_python(edits, mode="json")
        body: dict[str, Any] = {"edits": given} if edits else {"words": words}
        return self._update(self._api.post(self._path("/edits"), {**body, "version": self._version, "author": AUTHOR}))

    async def optimise(
        self,
        ctx: Context,
        recipe: Literal["feasible", "paper", "all-in-one"] = "feasible",
        only: Annotated[list[str], Field(description="Ids that may move; all when empty.")] = [],  # noqa: B006
        by_hand_too: Annotated[
            bool, Field(description="Whether what you or a person placed may move, too; it stays otherwise.")
        ] = False,
    ) -> dict[str, Any]:
        """Tidy up: objects rest on their supports and do not overlap. One step; `check` afterwards."""
        self._need_seen()
        body = {"version": self._version, "recipe": recipe, "only": only, "by_hand_too": by_hand_too, "author": AUTHOR}
        await anyio.to_thread.run_sync(lambda: self._api.post(self._path("/optimise"), body))
        return self._update(await self._outcome(ctx))

    def check(self) -> dict[str, Any]:
        """Whether people could use the room: collisions, floating, walkways, what is hard to reach; what to do."""
        answer: dict[str, Any] = self._api.get(self._path("/check"))
        return answer

    def questions(self) -> dict[str, Any]:
        """What you or the person could tell of the room, the answer that makes most objects right first."""
        asked: dict[str, Any] = self._api.get(self._path("/questions"))
        return self._update(asked)

    def answer(
        self,
        question: Annotated[str, Field(description="Its id, as `questions` tells it.")],
        value: Annotated[str, Field(description="One of its choices; any category, any id of an object or plane.")],
    ) -> dict[str, Any]:
        """Answer a question: what it asks is certain then, and only what depends on it changes. One step."""
        self._need_seen()
        body = {"version": self._version, "question": question, "answer": value, "author": AUTHOR}
        return self._update(self._api.post(self._path("/answers"), body))

    def undo(self) -> dict[str, Any]:
        """Take back your own last step."""
        return self._update(self._api.post(self._path("/undo"), {"author": AUTHOR}))

    def redo(self) -> dict[str, Any]:
        """Do again what you took back last."""
        return self._update(self._api.post(self._path("/redo"), {"author": AUTHOR}))

    def export(
        self,
        path: Annotated[str, Field(description="File to write on this machine; an existing one is replaced.")],
        format: Annotated[str, Field(description="glb, usdz, blend, mjcf, urdf, svg, ifc, html and others.")] = "glb",
    ) -> dict[str, Any]:
        """Write the open room as a file for other programs."""
        target = Path(path).expanduser().resolve()
        content = self._api.content(self._path(f"/export/{format}"))
        write_atomically(target, content)
        return {"file": str(target), "format": format, "bytes": len(content)}

    # -- resources -----------------------------------------------------------------------------------------------

    def scene_file(self) -> str:
        """The open room's scene file."""
        return self._api.content(self._path("/scene")).decode()

    @staticmethod
    def scene_schema() -> str:
        """The JSON schema of the scene file."""
        return json.dumps(scene_file_schema())

    @staticmethod
    def edits_schema() -> str:
        """The JSON schema of the edits."""
        return json.dumps(TypeAdapter(list[TypedEdit]).json_schema())

    # -- what they share -----------------------------------------------------------------------------------------

    @property
    def _room(self) -> str:
        if not self._project:
            raise InputError("no room is open; call rooms and open_room, or build")
        return self._project

    def _path(self, rest: str = "") -> str:
        return f"v1/projects/{self._room}{rest}"

    def _remember(self, scene: dict[str, Any]) -> dict[str, Any]:
        self._project, self._version = scene["project"], scene["version"]
        return scene

    def _need_seen(self) -> None:
        if not self._version:
            self._remember(self._api.get(self._path()))

    def _update(self, answer: dict[str, Any]) -> dict[str, Any]:
        self._version = answer["version"]
        return answer

    async def _outcome(self, ctx: Context) -> dict[str, Any]:
        """How the room's long work ended; raises `InputError` where it failed."""

        def poll() -> dict[str, Any]:
            answer: dict[str, Any] = self._api.get(self._path("/job"), wait_s=STEP_S)
            return answer

        while (job := await anyio.to_thread.run_sync(poll))["running"]:
            await ctx.report_progress(job["progress"], 1.0, job["message"])
        if job["error"]:
            raise InputError(job["error"])
        if job["message"] == "cancelled":
            raise InputError("it was cancelled in the browser; ask the person, or try again")
        return job
