"""A mark that a device writes behind its work: whether it has done the work.

A device that is lost, or that another program blocks, may give zeros, or what a buffer held before, without an error.
"""

from __future__ import annotations

from typing import Any

MARK = bytes(range(0xA0, 0xB0))
_FROM, _TO = 0x4, 0x8


class Mark:
    """It is written as the last command of an encoder."""

    def __init__(self, gpu: Any, encoder: Any) -> None:
        self.gpu = gpu
        self.written = gpu.create_buffer(size=len(MARK), usage=_FROM | _TO)
        source = gpu.create_buffer_with_data(data=MARK, usage=_FROM)
        encoder.copy_buffer_to_buffer(source, 0, self.written, 0, len(MARK))

    @property
    def is_there(self) -> bool:
        """Whether the commands were executed, after they were submitted; to be asked after their results were read."""
        return bytes(self.gpu.queue.read_buffer(self.written)) == MARK
