"""One progress bar over all stages of a run, with the time left."""

from __future__ import annotations

import time
from collections.abc import Mapping
from contextlib import nullcontext

from sssgen.jobs.executor import Progress
from sssgen.lab.chart.charting import Settings
from sssgen.support.progress import time_left

LAST = 99
"""The percentage before the end."""


class WholeProgress:
    """The percentage of a run, which advances with the items of its stages and never goes back."""

    def __init__(self, progress: Progress, stages: Mapping[str, int]) -> None:
        """`stages` has the stages in their order, and their shares of the time in percent."""
        self.progress, self.stages = progress, stages
        self.started, self.percent = time.monotonic(), 0

    @property
    def seconds(self) -> float:
        """The time since the run began."""
        return time.monotonic() - self.started

    def of(self, settings: Settings, stage: str, part: float = 1.0) -> Settings:
        """The settings of a part of a stage, whose items advance this bar."""
        progress = self.part(stage, part)
        return settings._replace(progress_bar=lambda: nullcontext(progress))

    def part(self, stage: str, part: float = 1.0) -> Progress:
        """The progress of a part of a stage: its share, and at most up to the stage's end."""
        names = list(self.stages)
        end = sum(self.stages[name] for name in names[: names.index(stage) + 1])
        begin = max(self.percent, end - self.stages[stage])
        span = min(part * self.stages[stage], max(end - begin, 0))

        def advance(done: float, total: int, name: str) -> None:
            percent = int(begin + span * done / max(total, 1))
            self.percent = max(self.percent, min(percent, LAST))
            self.progress(self.percent, 100, f"{name}{self._left()}")

        return advance

    def _left(self) -> str:
        """The time left, as text; '' in the first seconds."""
        if self.seconds < 10.0 or self.percent < 2:
            return ""
        return f"; {time_left(self.seconds * (100 - self.percent) / self.percent)}"
