"""The time of the light inside a body in Godot, as its node computes it when a light has moved.

    python benchmarks/godot_inner_light.py wax.bin    # of sssgen bake fluence SCENE --relit 16 -o wax.bin

The best of many runs, for lights whose direction is that of the whole body, for lights near to it, for surroundings,
and for the sum.
"""

from __future__ import annotations

import sys
from pathlib import Path

from sssgen.run.compilers.godot_process import find
from sssgen.targets import registry
from sssgen.targets.javascript_runtime import runtime_text

SCRIPT = """extends SceneTree

const Passes := preload("res://sssgen_passes.gd")

func best(work: Callable) -> float:
    var least := INF
    for run in 30:
        var start := Time.get_ticks_usec()
        work.call()
        least = minf(least, (Time.get_ticks_usec() - start) / 1000.0)
    return least

func _initialize() -> void:
    var start := Time.get_ticks_usec()
    var response := Passes.Response.load_from("res://body.bin")
    print("TIME to load: %.1f ms" % ((Time.get_ticks_usec() - start) / 1000.0))
    print("TIME %d voxels of %s texels" % [response.count, response.size])
    var strengths := PackedFloat32Array()
    strengths.resize(response.count)
    strengths.fill(1.0)
    var around := PackedVector4Array()
    around.resize(9)
    around.fill(Vector4(0.3, 0.2, 0.1, 0.0))
    var light := response.from_around(around)
    var inner := Passes.InnerLight.new({}, "res://body.bin")
    inner._parts = {1: light}
    var facts: PackedVector4Array = [Vector4(2, 2, 2, 1), Vector4(0, 0, 0, -1), Vector4(0.01, 2, 100, 1)]
    print("TIME a distant light: %.2f ms" % best(func(): response.from_afar(Vector3(0.48, 0.6, 0.64))))
    print("TIME a light near the body: %.2f ms" % best(func():
        response.from_near(Vector3(2, 2, 2), inner._strengths(facts, Transform3D.IDENTITY))))
    print("TIME surroundings: %.2f ms" % best(func(): response.from_around(around)))
    var near := func(): return response.from_near(Vector3(2, 2, 2), inner._strengths(facts, Transform3D.IDENTITY))
    print("TIME two moved lamps, in a thread beside the frames: %.2f ms" % best(func():
        inner._parts = {}
        inner._compute({[1]: near, [2]: near}, [[[1], Vector4.ONE], [[2], Vector4.ONE]])))
    inner._parts = {1: light}
    print("TIME the sum of each light: %.2f ms" % best(func(): inner._sum([[1, Vector4.ONE]])))
    print("TIME the texels: %.2f ms" % best(func(): response.slices(light)))
    OS.kill(OS.get_process_id())
"""


def main(file: str) -> None:
    """Prints the times for a file."""
    output = next(each for each in registry.load("godot").files["shader"] if each.sources)
    files = {
        "bench.gd": SCRIPT, output.name: runtime_text(output.sources, ""),
        "body.bin": Path(file).read_bytes(), "body.bin.json": Path(f"{file}.json").read_text("utf-8"),
    }  # fmt: skip
    godot = find()
    with godot.project(files) as project:
        printed = godot.run(project, "bench.gd", [], 120.0)
    print("\n".join(line.removeprefix("TIME ") for line in printed.splitlines() if line.startswith("TIME")) or printed)


if __name__ == "__main__":
    main(*sys.argv[1:])
