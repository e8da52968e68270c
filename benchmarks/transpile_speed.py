"""Measures the speed of the stages of `sssgen transpile` on a generated text, and how the time grows with its length.

The text repeats functions that are typical for effects (hashes, sums of noise, distances, colours), with comments,
macros, loops and swizzles; each copy has its number in its names. The stages run on 100 kB and on ten times as much: a
growth of 10 means that the time is proportional to the length.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

from sssgen.lang.check.context import Language
from sssgen.lang.check.module_checker import check_plain
from sssgen.lang.plain_glsl import preprocess_text
from sssgen.lang.syntax.parser import parse_tokens
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import Reporter
from sssgen.support.gc_pause import pause_gc

Result = TypeVar("Result")

FILE = "speed.glsl"
SIZE = 100_000
ROUNDS = 3

_HEAD = """// Noise, distances and colours, to measure with.
#define TURN 6.2831853
#define SQUARE(x) ((x) * (x))
"""
_PART = """
// A number from a point of the plane, the same for the same point.
float scatter_@(vec2 at) {
    vec3 mixed = fract(vec3(at.xyx) * vec3(0.3137, 0.2719, 0.4142));
    mixed += dot(mixed, mixed.zxy + 19.7);
    return fract((mixed.x + mixed.z) * mixed.y);
}

/* Octaves of smooth noise: `gain` is what each has of the one before. */
float layers_@(vec2 at, int octaves, float gain) {
    float sum = 0.0, weight = 0.5;
    for (int i = 0; i < octaves; ++i) {
        vec2 cell = floor(at);
        vec2 part = smoothstep(0.0, 1.0, at - cell);
        float low = mix(scatter_@(cell), scatter_@(cell + vec2(1.0, 0.0)), part.x);
        float high = mix(scatter_@(cell + vec2(0.0, 1.0)), scatter_@(cell + 1.0), part.x);
        sum += weight * mix(low, high, part.y);
        at = mat2(1.6, 1.2, -1.2, 1.6) * at + vec2(9.0, 4.0);
        weight *= gain;
        if (weight < 0.001) break;
    }
    return sum;
}

float ring_@(vec3 at, float radius, float tube) {
    vec2 side = vec2(length(at.xz) - radius, at.y);
    return sqrt(SQUARE(side.x) + SQUARE(side.y)) - tube;
}

vec3 tint_@(float share, const in vec3 base, inout float brightness) {
    vec3 wave = 0.5 + 0.5 * cos(TURN * (share + vec3(0.0, 0.33, 0.67)));
    brightness *= dot(wave, vec3(0.2126, 0.7152, 0.0722)) > 0.5 ? 0.9 : 1.1;
    return mix(base, wave, clamp(share, 0.0, 1.0)) * brightness;
}
"""


def text_of(size: int) -> str:
    """GLSL with at least `size` characters."""
    count = -(-size // len(_PART))
    return _HEAD + "".join(_PART.replace("@", str(number)) for number in range(count))


def stages(text: str, targets: Sequence[str]) -> dict[str, float]:
    """Stage → its shortest CPU time of several rounds, in seconds."""
    results: dict[str, float] = {}

    def timed(name: str, work: Callable[[], Result]) -> Result:
        with pause_gc():  # as in the command
            start = time.process_time()
            result = work()
        results[name] = min(results.get(name, float("inf")), time.process_time() - start)
        return result

    for _ in range(ROUNDS):
        words = timed("lex and preprocess", partial(preprocess_text, text, FILE))
        reporter = Reporter(FILE, text, words.texts)
        tree = timed("parse", partial(parse_tokens, words.tokens, words.comments, reporter, plain=True))
        module = timed("check", partial(check_plain, tree, reporter, Language()))
        for target in targets:
            timed(target, partial(transpile, module, target, "speed", keep=True))
    return results


def report(targets: Sequence[str]) -> None:
    """Prints the speed and the growth of each stage, and of all stages for each target."""
    small, large = text_of(SIZE), text_of(10 * SIZE)
    first, second = stages(small, targets), stages(large, targets)
    front = [name for name in first if name not in targets]
    print(f"{len(small) / 1000:.0f} kB of GLSL, then {len(large) / 1000:.0f} kB")
    print(f"{'':30}{'kB/s':>8}{'growth':>8}")
    for name in first:
        title = name if name in front else f"passes and print {name}"
        print(f"{title:30}{len(small) / 1000 / first[name]:8.0f}{second[name] / first[name]:8.1f}")
    for target in targets:
        whole = [sum(times[name] for name in [*front, target]) for times in (first, second)]
        print(f"{f'source to {target}':30}{len(small) / 1000 / whole[0]:8.0f}{whole[1] / whole[0]:8.1f}")
