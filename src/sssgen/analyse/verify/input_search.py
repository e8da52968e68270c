"""Inputs that reach what a function can do: its branches, the cases of its comparisons, and their boundaries.

Random inputs (`plain_inputs`) are run on the interpreter. Where few of them are defined, as in a whole shader whose
engine guarantees much of its uniforms, inputs with few undefined operations are changed step by step. Then, for each
comparison: where two inputs lie on both sides
of it, bisection finds neighbouring numbers on both sides; where only one side was reached, inputs that come near are
changed at random, step by step. Of all inputs, some are chosen for each outcome, the others as they were drawn.

The search is bounded by the number of operations that it runs, not by time: the same seed gives the same inputs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.analyse.verify.branch_outcomes import Outcomes, Site
from sssgen.analyse.verify.lane_interpreter import ROUNDS, Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.plain_inputs import (
    Numbers,
    Source,
    as_integers,
    draw_inputs,
    join,
    round_single,
    select_lanes,
    suggest_numbers,
)
from sssgen.analyse.verify.time_limit import TimeOverError
from sssgen.ir.types import kind_of
from sssgen.run.backends import Array
from sssgen.run.backends.call_program import grid

WORK = 60_000
"""How many operations on 2000 lanes a search runs at most, after the first run."""
FEWEST_STEPS = 4
"""The search for boundaries is left out where so few steps take more than `WORK`: they would not come near."""
SITES, BRACKETS = 64, 3
"""How many comparisons are searched, and from how many pairs of inputs."""
MIN_ROUNDS = 200
"""Inputs that bound loops may be large where the loops still take no more rounds, or no more than twice those of small
numbers."""
STEPS = 34
"""Steps of a bisection: a float has 32 bits."""
BOUNDARY_DISTANCES = (1, 2**6, 2**11, 2**16, 2**19)
"""Distances of further inputs from a boundary, in units in the last place: next to it rounding may decide."""
CLIMBS, CLIMBERS = 6, 16
"""Rounds of changing inputs that come near, and how many for each comparison."""
FEW_DEFINED, REPAIRED = 0.3, 64
"""The share of defined inputs below which others are repaired, and how many are."""
REPAIR_WORK = 1_500_000
"""As `WORK`, for the repair."""
UNDEFINED_SHARE = 0.05
"""The largest share of inputs for which the result is undefined."""
SEARCH_SHARE = 0.5
"""The share of inputs that the search chose, those for outcomes included."""
INPUTS_PER_OUTCOME = 6
"""How many inputs are chosen for each outcome."""


FEW = 64
"""The inputs whose run tells how long others take."""


class Samples(NamedTuple):
    """Inputs with what is known of them."""

    values: dict[str, Array]
    undefined: Array
    """The lanes with an undefined operation, also of their neighbours where they read these."""
    endless: Array
    faults: Array
    """How many operations of a lane were undefined."""
    rounds: int
    """Of all loops together."""
    work: int
    """The number of evaluated nodes."""
    outcomes: Outcomes
    random_count: int
    """How many of the first lanes were drawn at random; the search found the others."""

    @property
    def sound(self) -> Array:
        """The lanes without an undefined operation of their own; those of neighbours may reach them."""
        sound: Array = (self.faults == 0.0) & ~self.endless
        return sound

    def part(self, lanes: slice) -> Samples:
        """Some of the lanes, all of which were drawn at random."""
        values = {name: value[..., lanes] for name, value in self.values.items()}
        outcomes = self.outcomes.part(lanes)
        return self._replace(
            values=values,
            undefined=self.undefined[lanes],
            endless=self.endless[lanes],
            faults=self.faults[lanes],
            outcomes=outcomes,
            random_count=outcomes.lanes,
        )


class Search:
    """The search for one function."""

    def __init__(
        self, program: Program, key: str, sources: Sequence[Source], textures: Mapping[str, Any], seed: int
    ) -> None:
        self.program, self.key, self.sources, self.textures, self.seed = program, key, sources, textures, seed
        self.numbers: Numbers = suggest_numbers(program.module)
        self.rng = np.random.default_rng([seed, 1])
        self.work = 0.0
        self.limit = ROUNDS
        self.ended_early = False

    def time_of_few(self, clock: Callable[[], float]) -> float:
        """The seconds of a run of a few inputs."""
        start = clock()
        self.run(draw_inputs(self.sources, FEW, self.numbers, self.seed))
        self.work = 0.0
        return clock() - start

    def inputs(self, samples: int) -> Samples:
        """Many inputs; those of the search are missing where it `ended_early`."""
        values = draw_inputs(self.sources, 2 * samples, self.numbers, self.seed)
        first = self.run(values)
        try:
            return self.more_inputs(first, samples)
        except TimeOverError:
            self.ended_early = True
            return first

    def more_inputs(self, first: Samples, samples: int) -> Samples:
        """The first inputs and those of the search."""
        values = first.values
        self.limit = max(MIN_ROUNDS, 2 * first.rounds)
        if any(source.bounds_loops for source in self.sources):
            free = [source._replace(bounds_loops=False) for source in self.sources]
            large = self.run(draw_inputs(free, samples, self.numbers, self.seed))
            values = join([values, select_lanes(large.values, ~large.endless)])
            first = self.run(values)
        self.work = 0.0
        parts = [values]
        if first.sound.mean() < FEW_DEFINED:
            parts.append(self.repair(first))
            first = self.run(join(parts))._replace(random_count=first.random_count)
            parts = [first.values]
        affordable = FEWEST_STEPS * self.cost(first.work, BRACKETS) < WORK
        self.work = 0.0
        if first.outcomes.distances and affordable:
            parts += [self.boundaries(first), self.approach(first)]
        parts = [part for part in parts if part]
        return self.run(join(parts))._replace(random_count=first.random_count) if len(parts) > 1 else first

    def run(self, values: dict[str, Array]) -> Samples:
        """Runs inputs; where lanes read their neighbours, the last is repeated to fill the grid."""
        lanes = next(value.shape[-1] for value in values.values())
        shape = grid(lanes)
        if self.program.neighbours and lanes < shape.rows * shape.width:
            values = select_lanes(values, np.arange(shape.rows * shape.width).clip(max=lanes - 1))
            lanes = shape.rows * shape.width
        outcomes = Outcomes(lanes)
        run = Run(self.program, lanes, {**self.textures, **values}, outcomes, limit=self.limit)
        run.result(self.key, {**self.textures, **values})
        self.work += self.cost(run.work, lanes)
        return Samples(values, run.undefined, run.endless, run.faults, run.rounds, run.work, outcomes, lanes)

    @staticmethod
    def cost(work: int, lanes: int) -> float:
        """How many operations on 2000 lanes take as long."""
        return work * (1.0 + lanes / 2000.0) / 2.0

    def best_of_rounds(self, rounds: list[dict[str, Array]], lanes: int) -> list[dict[str, Array]]:
        """Of the inputs of each round, those to compare: as many as `lanes`; the first where the time is over."""
        try:
            return self.choose_of_rounds(rounds, lanes)
        except TimeOverError:
            self.ended_early = True
            return [select_lanes(values, np.arange(lanes)) for values in rounds]

    def choose_of_rounds(self, rounds: list[dict[str, Array]], lanes: int) -> list[dict[str, Array]]:
        if self.program.neighbours:
            sampled = [self.run(values) for values in rounds]
            return [select_lanes(of_round.values, select_quads(of_round, lanes)) for of_round in sampled]
        together = self.run(join(rounds))
        ends = np.cumsum([next(iter(values.values())).shape[-1] for values in rounds])
        parts = [together.part(slice(start, end)) for start, end in zip([0, *ends[:-1]], ends, strict=True)]
        return [select_lanes(part.values, select_inputs(part, lanes, self.seed)) for part in parts]

    def rounds(self, sampled: Samples, count: int, lanes: int) -> list[dict[str, Array]]:
        """The inputs of each round: in one round, all lanes have the same uniforms.

        With several rounds each has more lanes than requested, of which some may be chosen. Where few inputs are
        defined, the lanes of a round are changes of one of these, as most other pairs of uniforms and inputs are not.
        """
        order = select_inputs(sampled, max(lanes, 4 * count) if count > 1 else lanes, self.seed)
        if count == 1 or not len(order):
            return [select_lanes(sampled.values, order)]
        scarce = 0.0 < sampled.sound.mean() < FEW_DEFINED
        order = self.rng.permutation(np.flatnonzero(sampled.sound)) if scarce else order
        rounds = []
        for number in range(count):
            first = order[number * len(order) // count]
            if scarce:
                values = self.change_gently(select_lanes(sampled.values, np.full(8 * lanes, first)))
            else:
                values = select_lanes(sampled.values, np.resize(np.roll(order, -number * lanes), 4 * lanes))
            for source in self.sources:
                if source.uniform:
                    value = values[source.name]
                    same = sampled.values[source.name][..., first, None]
                    values[source.name] = np.broadcast_to(same, value.shape).copy()
            rounds.append(values)
        return rounds

    # Boundaries

    def boundaries(self, first: Samples) -> dict[str, Array]:
        """Neighbouring inputs on both sides of each comparison."""
        usable = ~(first.undefined | first.endless)
        starts: list[tuple[Site, int, int]] = []
        for site, distance in list(first.outcomes.distances.items())[:SITES]:
            below, above = (np.flatnonzero(usable & side) for side in (distance < 0.0, distance > 0.0))
            if len(below) and len(above):
                pairs = zip(self.rng.choice(below, BRACKETS), self.rng.choice(above, BRACKETS), strict=True)
                starts += [(site, int(low), int(high)) for low, high in pairs]
        if not starts:
            return {}
        sites, low, high = self.narrow(first.values, starts)
        low, high = self.encode(low), self.encode(high)
        near, far = low, high
        for _ in range(STEPS):
            middle = {name: value + (high[name] - value) // 2 for name, value in low.items()}
            if self.work > WORK or all((middle[name] == value).all() for name, value in low.items()):
                break
            sampled = self.run(self.decode(middle))
            distances = self.at(sampled, sites)
            under = distances < 0.0
            low = {name: np.where(under, middle[name], value) for name, value in low.items()}
            high = {name: np.where(under, value, middle[name]) for name, value in high.items()}
        parts = [low, high]
        for step in BOUNDARY_DISTANCES:
            parts.append({name: _towards(value, far[name], step) for name, value in high.items()})
            parts.append({name: _towards(value, near[name], step) for name, value in low.items()})
        return join([self.decode(part) for part in parts])

    def narrow(
        self, values: dict[str, Array], starts: list[tuple[Site, int, int]]
    ) -> tuple[list[Site], dict[str, Array], dict[str, Array]]:
        """For each pair of lanes, one that differs in a single source where that suffices: (sites, low, high)."""
        names = [source.name for source in self.sources]
        sites = [site for site, *_ in starts]
        below, above = (np.array([start[index] for start in starts]) for index in (1, 2))
        low, high = select_lanes(values, below), select_lanes(values, above)
        if len(names) == 1:
            return sites, low, high
        tried = [self.rng.permutation(len(names))[:6] for _ in starts]
        count = max(map(len, tried))
        for attempt in range(count):
            for from_low in (True, False):
                base, other = (low, high) if from_low else (high, low)
                mixed = {
                    name: np.where([names[t[attempt % len(t)]] == name for t in tried], other[name], base[name])
                    for name in names
                }
                distances = self.at(self.run(mixed), sites)
                if from_low:
                    better = distances > 0.0
                    high = {name: np.where(better, mixed[name], value) for name, value in high.items()}
                else:
                    better = distances < 0.0
                    low = {name: np.where(better, mixed[name], value) for name, value in low.items()}
            if self.work > WORK / 2:
                break
        return sites, low, high

    def at(self, sampled: Samples, sites: list[Site]) -> Array:
        """The distance of each lane at its own comparison; positive where it does not reach it."""
        result = np.full(len(sites), np.inf)
        for index, site in enumerate(sites):
            distance = sampled.outcomes.distances.get(site)
            if distance is not None and not np.isnan(distance[index]):
                result[index] = distance[index]
        return result

    # Sides that are not reached

    def approach(self, first: Samples) -> dict[str, Array]:
        """Inputs that come nearer to the other side of comparisons of which only one was reached."""
        usable = ~(first.undefined | first.endless)
        sites: list[Site] = []
        lanes: list[int] = []
        for site, distance in list(first.outcomes.distances.items())[:SITES]:
            reached = distance[usable & ~np.isnan(distance)]
            if len(reached) and ((reached > 0.0).all() or (reached < 0.0).all()):
                order = np.argsort(np.where(usable & ~np.isnan(distance), np.abs(distance), np.inf), kind="stable")
                sites += [site] * CLIMBERS
                lanes += [int(lane) for lane in np.resize(order[: min(CLIMBERS, len(reached))], CLIMBERS)]
        if not sites:
            return {}
        best = select_lanes(first.values, np.array(lanes))
        nearest = np.abs(self.at(self.run(best), sites))
        for number in range(CLIMBS):
            if self.work > WORK:
                break
            changed = self.change(best, number)
            distances = self.at(self.run(changed), sites)
            better = np.abs(distances) < nearest
            nearest = np.where(better, np.abs(distances), nearest)
            best = {name: np.where(better, changed[name], value) for name, value in best.items()}
        return best

    def change(self, values: dict[str, Array], number: int) -> dict[str, Array]:
        """Inputs with one source changed: another random one, or a step of any size."""
        lanes = next(value.shape[-1] for value in values.values())
        fresh = draw_inputs(self.sources, lanes, self.numbers, self.seed + 1000 + number)
        chosen = self.rng.integers(0, len(self.sources), lanes)
        coded = self.encode(values)
        result = {}
        for position, source in enumerate(self.sources):
            value = values[source.name]
            step = self.rng.choice([-1, 1], value.shape) * (1 << self.rng.integers(0, 30, value.shape))
            stepped = self.decode({source.name: coded[source.name] + step})[source.name]
            new = np.where(self.rng.random(value.shape) < 0.5, fresh[source.name], stepped)
            if source.bounds_loops:
                new = fresh[source.name]
            result[source.name] = np.where(chosen == position, new, value)
        return result

    # Inputs with undefined operations

    def repair(self, first: Samples) -> dict[str, Array]:
        """Inputs made of those with the fewest undefined operations, by changes that do not add one."""
        faults = first.faults + np.where(first.endless, np.inf, 0.0)
        chosen = np.resize(np.argsort(faults, kind="stable")[:REPAIRED], REPAIRED)
        best, fewest = select_lanes(first.values, chosen), faults[chosen]
        for number in range(len(fewest) * 4):
            if self.work > REPAIR_WORK or np.median(fewest) == 0.0:
                break
            changed = self.change_gently(best)
            run = self.run(changed)
            count = run.faults + np.where(run.endless, np.inf, 0.0)
            better = count <= fewest
            best = {name: np.where(better, changed[name], value) for name, value in best.items()}
            fewest = np.where(better, count, fewest)
            if number % 8 == 7:  # the worst quarter starts again from the best
                order = np.argsort(fewest, kind="stable")
                order[-REPAIRED // 4 :] = order[: REPAIRED // 4]
                best, fewest = select_lanes(best, order), fewest[order]
        return best

    def change_gently(self, values: dict[str, Array]) -> dict[str, Array]:
        """Inputs with some sources changed: to numbers in [0, 1], [1, 8] or [-1, 0], or to those of another input."""
        lanes = next(value.shape[-1] for value in values.values())
        share = 2.0 ** self.rng.uniform(0.0, 4.0, lanes) / max(len(self.sources), 1)
        result = {}
        for source in self.sources:
            value = values[source.name]
            new = value[..., self.rng.permutation(lanes)]
            if kind_of(source.type) == "float":
                low, high = self.rng.choice([(0.0, 1.0), (0.0, 1.0), (1.0, 8.0), (-1.0, 0.0)], lanes).T
                new = np.where(
                    self.rng.random(lanes) < 0.7, round_single(self.rng.uniform(low, high, value.shape)), new
                )
            result[source.name] = np.where(self.rng.random(lanes) < share, new, value)
        return result

    # Numbers as integers in the same order

    def encode(self, values: dict[str, Array]) -> dict[str, Array]:
        """Neighbouring floats as neighbouring integers; integers as they are."""
        return {source.name: _encode(values[source.name]) for source in self.sources}

    def decode(self, codes: dict[str, Array]) -> dict[str, Array]:
        """The numbers of `coded`."""
        kinds = {source.name: kind_of(source.type) for source in self.sources}
        return {name: _decode(value, kinds[name]) for name, value in codes.items()}


def _towards(start: Array, end: Array, step: int) -> Array:
    """At most so many steps from one number towards another."""
    moved: Array = start + np.clip(end - start, -step, step)
    return moved


def _encode(value: Array) -> Array:
    if value.dtype.kind != "f":
        return value.astype(np.int64)
    bits = value.astype(np.float32).view(np.int32).astype(np.int64)
    return np.where(bits < 0, -(bits & 0x7FFFFFFF), bits)


def _decode(code: Array, kind: str) -> Array:
    if kind == "bool":
        return np.not_equal(code, 0)
    if kind in ("int", "uint"):
        low, high = (-(2**31), 2**31 - 1) if kind == "int" else (0, 2**32 - 1)
        return as_integers(np.clip(code, low, high), kind)
    largest, smallest = 0x7F7FFFFF, 0x00800000
    code = np.clip(code, -largest, largest)
    code = np.where(np.abs(code) < smallest, np.where(2 * np.abs(code) < smallest, 0, np.sign(code) * smallest), code)
    bits = np.where(code < 0, -code | 0x80000000, code).astype(np.uint32)
    floats: Array = bits.view(np.float32).astype(np.float64)
    return floats


def select_inputs(sampled: Samples, count: int, seed: int) -> Array:
    """The lanes of `count` inputs: for each outcome some, then others as they were drawn."""
    rng = np.random.default_rng([seed, 2])
    lanes = sampled.outcomes.lanes
    defined = ~(sampled.undefined | sampled.endless)
    reached = [*sampled.outcomes.branches.values(), *sampled.outcomes.cases.values()]
    each = max(1, min(INPUTS_PER_OUTCOME, count // (2 * max(len(reached), 1))))
    order = rng.permutation(lanes)
    picked: dict[int, None] = {}
    for mask in sorted(reached, key=lambda mask: int((mask & defined).sum())):
        for lane in order[(mask & defined)[order]][:each]:
            picked[int(lane)] = None
    search_lanes = [int(lane) for lane in order if lane >= sampled.random_count and defined[lane]]
    picked = dict.fromkeys([*list(picked), *search_lanes][: max(len(picked), int(SEARCH_SHARE * count))][:count])
    rest = [int(lane) for lane in range(lanes) if defined[lane] and lane not in picked]
    undefined = [int(lane) for lane in np.flatnonzero(sampled.undefined & ~sampled.endless)]
    room = count - len(picked)
    result = [*picked, *rest[:room]]
    if not defined.any():
        result = undefined[:count]
    elif len(result) + 0 < count or undefined:
        extra = undefined[: max(0, min(int(UNDEFINED_SHARE * count), count - len(picked)))]
        result = [*result[: count - len(extra)], *extra]
    if not result:
        return np.zeros(0, np.int64)
    return np.resize(np.array(result, np.int64), count) if len(result) < count else np.array(result[:count], np.int64)


def select_quads(sampled: Samples, count: int) -> Array:
    """The lanes of the quads with the fewest undefined operations, so placed that `count` lanes are these quads."""
    shape = grid(sampled.outcomes.lanes)
    width = shape.width // 2 * 2
    image = np.arange(shape.rows * shape.width).reshape(shape.rows, shape.width)[:, :width]
    quads = image.reshape(shape.rows // 2, 2, width // 2, 2).swapaxes(1, 2).reshape(-1, 2, 2)
    faults = sampled.faults + np.where(sampled.undefined | sampled.endless, 1.0, 0.0)
    order = np.argsort(faults[quads].sum(axis=(1, 2)), kind="stable")
    chosen: Array = quads[np.resize(order, count // 4)].swapaxes(0, 1)
    return chosen.reshape(-1)
