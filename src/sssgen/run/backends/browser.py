"""WebGPU in a headless browser: Chromium or Chrome, whose compiler is Tint, or Firefox, whose compiler is naga.

$SSSGEN_CHROMIUM and $SSSGEN_FIREFOX name the browsers' programs; else installed ones are used. $SSSGEN_BROWSER_ADAPTER
names Chromium's adapter: `swiftshader`, which it always has and which computes on the CPU, or `default` for the
machine's GPU. Firefox takes the adapter that Vulkan, Metal or Direct3D 12 has, and does not name it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.run.backends.backend_interface import Array, Drawing, backend_failure, refusal
from sssgen.run.backends.browser_page import START, WEBGPU, LostError, Page
from sssgen.run.backends.call_program import FRAGMENT
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.run.backends.webgpu_plan import Plan, layout_entries, plan
from sssgen.run.compilers import CompilerMissing, Message
from sssgen.run.machine_parts import chromium, firefox

SECONDS = 60.0
"""How long a small draw may take; a large one gets more, see `_extra`."""


_WHOLE_QUADS = "diagnostic(off, derivative_uniformity);"
"""For the program around functions: whole quads take its branches, which Tint cannot prove."""


class Browser(DrawingBackend):
    """A page executes the plans; a browser that is lost is started again for the next draw.

    `seconds`: how long a small draw may take; `program`: chromium or firefox.
    """

    top_first = True

    def __init__(self, name: str, target: str, seconds: float = SECONDS, program: str = "chromium") -> None:
        super().__init__(name, target)
        self.seconds, self.program = seconds, program
        self.page, self.facts = _OPEN[program]()

    def device(self) -> str:
        return (
            f"{_COMPILERS[self.program]} {self.facts['version']} on {self.facts['adapter'] or 'the machine’s adapter'}"
        )

    def draw(self, drawing: Drawing) -> Array:
        self.check(drawing)
        drawing_plan = plan(drawing)
        if drawing.fragment.entry == FRAGMENT:
            drawing_plan = drawing_plan._replace(
                code=_WHOLE_QUADS + drawing_plan.code
            )  # on the first line: line numbers stay the same
        head, data = _pack(drawing_plan)
        seconds = self.seconds + _extra(drawing_plan, len(data))
        try:
            if not self.page.alive():
                self.page.close()
                self.page, self.facts = _OPEN[self.program]()
            self.page.send(head, data, seconds)
            answer, picture = self.page.receive(seconds)
        except LostError as reason:
            raise backend_failure(self.name, f"the browser {reason}") from None
        except CompilerMissing as reason:
            raise backend_failure(self.name, f"the browser ended and cannot be restarted: {reason}") from None
        if "messages" in answer:
            messages = [Message("error", line, column, _first(text)) for line, column, text in answer["messages"]]
            raise refusal(self.name, drawing.fragment.text, messages)
        if "lost" in answer:
            self.page.close()
            raise backend_failure(self.name, f"the browser lost its device: {answer['lost']}")
        if "error" in answer:
            raise backend_failure(self.name, _first(answer["error"]))
        self.draw_seconds = answer["drew"]
        dtype: Any = np.float32 if drawing.floats else np.uint32
        rows = np.frombuffer(bytearray(picture), dtype).reshape(drawing_plan.height, answer["stride"] // 4)
        return rows[:, : drawing_plan.width * 4].reshape(drawing_plan.height, drawing_plan.width, 4)


def _open() -> tuple[Page, dict[str, Any]]:
    """A page in Chromium with a device, and its version and adapter. Raises CompilerMissing where there is none."""
    program = chromium()
    if not program:
        raise CompilerMissing("chromium (Debian: chromium · elsewhere: Chrome; or set SSSGEN_CHROMIUM)")
    adapter = os.environ.get("SSSGEN_BROWSER_ADAPTER", "swiftshader")
    return _page("chromium", program, adapter, WEBGPU, f" (SSSGEN_BROWSER_ADAPTER={adapter})")


def _open_firefox() -> tuple[Page, dict[str, Any]]:
    """The same in Firefox."""
    program = firefox()
    if not program:
        raise CompilerMissing("firefox (Debian: firefox-esr; or set SSSGEN_FIREFOX)")
    return _page("firefox", program, "", None, "")


_OPEN = {"chromium": _open, "firefox": _open_firefox}
_COMPILERS = {"chromium": "Tint in Chromium", "firefox": "naga in Firefox"}


def _page(
    name: str, program: str, adapter: str, switches: Sequence[str] | None, setting: str
) -> tuple[Page, dict[str, Any]]:
    script = Path(__file__).with_name("browser.js").read_text(encoding="utf-8")
    try:
        page = Page(program, adapter, script, switches)
        facts, _ = page.receive(START)
    except LostError as reason:
        raise CompilerMissing(f"{name} that starts: {program} {reason}") from None
    if "error" in facts:
        page.close()
        raise CompilerMissing(f"{name} with WebGPU: {program}: {facts['error']}{setting}")
    return page, facts


def _pack(drawing_plan: Plan) -> tuple[str, bytes]:
    """The plan as JSON, with `{at, size}` in place of each piece of the bytes, and the bytes."""
    pieces: list[bytes] = []
    end = 0

    def piece(data: bytes) -> dict[str, int]:
        nonlocal end
        pieces.append(data)
        end += len(data)
        return {"at": end - len(data), "size": len(data)}

    textures = [
        texture._asdict() | {"levels": [level._asdict() for level in texture.levels]}
        for texture in drawing_plan.textures
    ]
    lists = {
        "textures": textures,
        "blocks": [block._asdict() for block in drawing_plan.blocks],
        "groups": _groups(drawing_plan),
    }
    return json.dumps(drawing_plan._asdict() | lists, default=piece), b"".join(pieces)


def _groups(drawing_plan: Plan) -> list[list[dict[str, Any]]]:
    """The entries of each group's layout in JavaScript's spelling."""
    groups = layout_entries(drawing_plan)
    for entry in (entry for entries in groups.values() for entry in entries):
        if "texture" in entry:
            reads = entry["texture"]
            entry["texture"] = {"sampleType": reads["sample_type"], "viewDimension": reads["view_dimension"]}
    return [groups.get(i, []) for i in range(max(groups, default=-1) + 1)]


def _first(text: str) -> str:
    """The first line; candidates and the place in the browser's code follow it."""
    return text.split("\n")[0]


def _extra(drawing_plan: Plan, size: int) -> float:
    """Additional seconds for large draws: 30 for each million pixels, 0.1 for each million bytes."""
    return 30e-6 * drawing_plan.width * drawing_plan.height + 0.1e-6 * size
