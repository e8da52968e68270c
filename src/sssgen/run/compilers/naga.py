"""WGSL in naga, the compiler of wgpu and of Firefox. Its uniformity check is off: Tint has that one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from sssgen.run.compilers.calling_entry import wgsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Source
from sssgen.support.installation import install_hint


class Naga(Compiler):
    """Makes shader modules on whatever adapter there is; without a GPU that is Mesa's lavapipe."""

    name = "naga"

    def __init__(self, device: Any, adapter: str) -> None:
        self.gpu = device
        self._adapter = adapter

    def version(self) -> str:
        import wgpu

        return f"naga in wgpu {wgpu.__version__} on {self._adapter}"

    def check(self, source: Source) -> list[Message]:
        return self.complaints(wgsl_entry(source.text) if source.stage == "library" else source.text)

    def complaints(self, text: str) -> list[Message]:
        """The messages of naga about a whole module."""
        import wgpu

        try:
            self.gpu.create_shader_module(code=text)
        except wgpu.GPUError as error:
            return [_message(str(error))]
        return []


def find() -> Naga:
    """naga behind a WebGPU device. Raises CompilerMissing where wgpu or an adapter is lacking."""
    import os
    import tempfile

    try:
        import wgpu
    except ImportError:
        raise CompilerMissing(install_hint("webgpu")) from None
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())  # EGL complains on stderr without it
    try:
        adapter = wgpu.gpu.request_adapter_sync(power_preference="low-power")
        if str(adapter.info["backend_type"]).lower().startswith("opengl"):  # it lacks what WebGPU promises
            raise CompilerMissing("only OpenGL is available")
        features: Any = sorted({"shader-f16"} & set(adapter.features))
        return Naga(adapter.request_device_sync(required_features=features), _device_name(adapter.info))
    except Exception as error:
        raise CompilerMissing(f"a Vulkan driver (Debian: mesa-vulkan-drivers libvulkan1): {error}") from None


def _device_name(info: Mapping[str, Any]) -> str:
    """The device, the interface through which it is reached, and its driver: `llvmpipe …, Vulkan, Mesa 22.3.6 …`."""
    return ", ".join([str(info[key]) for key in ("device", "backend_type", "description") if info.get(key)])


def _message(log: str) -> Message:
    """naga stops at the first error: its text, the notes under it, and the first place that it points to."""
    place = re.search(r"\u250c\u2500 \w*:(\d+):(\d+)", log)
    body = re.sub(r"(?s).*?(?:parsing|validation) error:\s*", "", log, count=1)
    first = next((line.strip() for line in body.splitlines() if line.strip()), log)
    notes = re.findall(r"^[ \u2502]*\^+ +(\w.*)$|^ += (?:note: )?(.*)$", body, re.MULTILINE)
    parts = [first, *(note for note in ("".join(pair) for pair in notes) if note not in first)]
    line, column = (int(place[1]), int(place[2])) if place else (0, 0)
    return Message("error", line, column, "; ".join(parts))
