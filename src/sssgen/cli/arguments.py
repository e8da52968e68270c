"""The command line's grammar. It stands apart as building it with argparse takes as long as emitting a shader."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from typing import NoReturn

from sssgen.cli.arguments_bake import add_baking
from sssgen.support.diagnostics import did_you_mean, failure

GUARDS = ("auto", "all", "none")
GUARDS_HELP = "make safe what may fail: auto (default) where it is not proven safe, all everywhere, none nowhere"


class _Parser(argparse.ArgumentParser):
    """argparse, whose errors are ours."""

    def error(self, message: str) -> NoReturn:
        hint = f"see: {self.prog} --help"
        if found := re.match(r"argument ([^:]+): invalid choice: '?(.*?)'? \(choose from (.*)\)", message):
            which, word, known = found.groups()
            choices = re.findall(r"[\w-]+", known)
            message = f"unknown {'command' if which == 'COMMAND' else which.lower()} '{word}'"
            hint = did_you_mean(word, choices) or f"choose from: {', '.join(choices)}"
        elif found := re.match(r"argument (?:\S+/)?(--[\w-]+): expected one argument", message):
            hint = f"a value that begins with - is written {found[1]}=VALUE"
        raise failure(message, hint)


def parser() -> argparse.ArgumentParser:
    """The command line's grammar."""
    top = _Parser(
        prog="sssgen",
        description="Generates shaders for translucent and parallax materials from one description.",
        epilog="Exit status: 0 done, 1 a check failed, 2 wrong input.\nOf one command: sssgen COMMAND --help",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show the version")
    commands = top.add_subparsers(metavar="COMMAND", dest="COMMAND", required=True)

    def command(name: str, module: str, text: str, epilog: str = "") -> argparse.ArgumentParser:
        made: argparse.ArgumentParser = commands.add_parser(
            name,
            help=text,
            description=text[0].upper() + text[1:] + ".",
            epilog=epilog,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        made.set_defaults(module=module)
        made.add_argument("--json", action="store_true", help="print the result, or the errors, as JSON")
        return made

    listing = command("list", "listing", "list what there is to choose from")
    listing.add_argument(
        "KIND", choices=("techniques", "targets", "materials"), help="techniques, targets or materials"
    )
    listing.add_argument("--role", metavar="R", help="only the techniques of this role")

    show = command("show", "show", "show a technique: what it does, what it takes, where it comes from")
    show.add_argument("TECHNIQUE", help="a name of `sssgen list techniques`, or a .sss file")

    emit = command(
        "emit",
        "emit",
        "write the shaders of materials",
        "examples:\n  sssgen emit ice --target all -o out\n  sssgen emit wax.toml -t wgsl,unity-urp -o out",
    )
    emit.add_argument("MATERIAL", nargs="+", help="a .toml file, or an example of `sssgen list materials`")
    emit.add_argument(
        "--target", "-t", metavar="T,T|all", required=True, help="targets of `sssgen list targets`, or all"
    )
    emit.add_argument("-o", "--output", metavar="DIR", required=True, help="the folder to write to; made if need be")
    emit.add_argument(
        "--form",
        choices=("shader", "functions"),
        default="shader",
        help="whole shaders (default), or functions to paste into one's own",
    )
    emit.add_argument("--guards", choices=GUARDS, default="auto", help=GUARDS_HELP)
    emit.add_argument("--templates", metavar="DIR", help="a folder of templates that stand before ours")

    check = command(
        "check",
        "check",
        "compile shaders with the compilers of this machine",
        "examples:\n  sssgen check ice\n  sssgen check wax.toml --target wgsl,hlsl\n  sssgen check out mine.frag",
    )
    check.add_argument("FILE", nargs="+", help="a shader, a folder of them, a material's .toml file, or an example")
    check.add_argument(
        "--target",
        "-t",
        metavar="T,T|all",
        action="append",
        help="only these targets; of a shader whose name does not tell its language, the language",
    )
    check.add_argument("--compiler", metavar="NAME", action="append", help="only this compiler; may be repeated")
    check.add_argument("--unity-includes", metavar="DIR", help="the folder of Unity's own headers")

    transpile = command(
        "transpile",
        "transpile",
        "translate plain GLSL, functions or whole shaders, to a target's language",
        "examples:\n"
        "  sssgen transpile noise.glsl --target wgsl -o noise.wgsl\n"
        "  sssgen transpile scene.glsl --entry shadertoy --target hlsl\n"
        "  sssgen transpile library/fbm.glsl -I library -D OCTAVES=5 --prune --target unity-urp\n"
        "  sssgen transpile noise.glsl --verify\n"
        "  sssgen transpile noise.glsl --as technique --function snoise\n"
        "What is taken: docs/transpile.md. Exit status 1: --verify found a difference.",
    )
    transpile.add_argument("FILE", help="a file of GLSL 1.00 ES to 4.60: functions, or a fragment or vertex shader")
    transpile.add_argument("--target", "-t", metavar="T", help="a target of `sssgen list targets`")
    transpile.add_argument(
        "--include", "-I", metavar="DIR", action="append", default=[], help="look here for #include, too; repeatable"
    )
    transpile.add_argument(
        "--define", "-D", metavar="NAME[=VALUE]", action="append", default=[], help="define a macro; repeatable"
    )
    transpile.add_argument("--entry", choices=("shadertoy",), default="", help="how the file is entered: by main")
    transpile.add_argument("--prune", action="store_true", help="leave out functions that the file itself never calls")
    transpile.add_argument(
        "--guards", choices=GUARDS, default="none", help="make safe what may fail: nowhere (default), auto, or all"
    )
    transpile.add_argument("-o", "--output", metavar="FILE", help="the file to write, and its reflection beside it")
    transpile.add_argument(
        "--verify", action="store_true", help="run every function as written and as translated, and tell the difference"
    )
    transpile.add_argument("--samples", type=int, default=1000, metavar="N", help="random inputs of --verify (1000)")
    transpile.add_argument("--seed", type=int, default=0, metavar="N", help="of the random inputs (0)")
    transpile.add_argument(
        "--as", dest="as_", choices=("technique",), help="write a function as a technique's file, to be filled in"
    )
    transpile.add_argument("--function", metavar="NAME", default="", help="which one (the file's last)")

    lint = command(
        "lint",
        "lint",
        "tell what may go wrong in techniques, materials and plain GLSL, and what is proven not to",
        "examples:\n  sssgen lint ice\n  sssgen lint mine.glsl --json\n"
        "Exit status 1: a plain function may fail. What a material emits is guarded.",
    )
    lint.add_argument("NAME", nargs="+", help="a technique, a material's .toml file, an example, or a GLSL file")
    lint.add_argument("--all", action="store_true", help="also what is proven safe")
    lint.add_argument("--no-examples", action="store_true", help="do not look for inputs that fail: quicker")

    evaluate = command(
        "eval",
        "eval",
        "evaluate a technique on arrays of inputs, on one back end or on all of them against the oracle",
        "examples:\n"
        "  sssgen eval lobe_gdc2011 --inputs lobe.json --backend all\n"
        "  sssgen eval standard --samples 10000 --backend all\n"
        "  sssgen eval march_light --inputs rays.json --bind body_distance=shapes.sss:star\n"
        "The inputs are numbers by name, one or a list of them: "
        '{"N": [[0, 0, 1], [0, 1, 0]], "power": 4.0, "map": "wood.png"}',
    )
    evaluate.add_argument("TECHNIQUE", help="a name of `sssgen list techniques`, a .sss file, or FILE:FUNCTION")
    evaluate.add_argument(
        "--inputs", "-i", metavar="FILE", help="the inputs, in JSON; - reads them from the standard input"
    )
    evaluate.add_argument(
        "--samples", type=int, metavar="N", help="N random inputs, each in its range, for what --inputs does not have"
    )
    evaluate.add_argument("--seed", type=int, default=0, metavar="N", help="which random inputs (default: 0)")
    evaluate.add_argument(
        "--backend", "-b", metavar="NAME", default="numpy",
        help="numpy (default), gl, gl-es, webgpu, browser, hlsl, hlsl-glslang, unity, unity-urp, several, or all",
    )  # fmt: skip
    evaluate.add_argument(
        "--bind", action="append", default=[], metavar="SLOT=FUNCTION", help="a function for a slot, or FILE:FUNCTION"
    )
    evaluate.add_argument("--guards", choices=GUARDS, default="auto", help=GUARDS_HELP)
    evaluate.add_argument("--precision", choices=("f64", "f32", "f16"), help="of numpy (default: f64); webgpu has f16")

    stress = command(
        "stress",
        "stress",
        "run techniques on dangerous, boundary and random inputs, on several back ends",
        "examples:\n"
        "  sssgen stress lobe_normalized\n"
        "  sssgen stress wax.toml --backend gl,webgpu --samples 1000000 -o stress.md\n"
        "Without a name: the library, but its published baselines.",
    )
    stress.add_argument("NAME", nargs="*", help="a technique, a .sss file, a material's .toml file, or an example")
    stress.add_argument(
        "--backend", "-b", metavar="NAME", help="default: numpy-f32,gl,webgpu,browser,hlsl; several, or all"
    )
    stress.add_argument("--samples", type=int, default=10_000, metavar="N", help="random inputs (default: 10000)")
    stress.add_argument("--seed", type=int, default=0, metavar="N", help="which random inputs (default: 0)")
    stress.add_argument(
        "--row", action="append", default=[], metavar="NAME", help="only this row of the dangerous table; repeatable"
    )
    stress.add_argument("--precision", choices=("f32", "f16"), help="f16: numpy and webgpu, in half (default: f32)")
    stress.add_argument("--guards", choices=GUARDS, default="auto", help=GUARDS_HELP)
    stress.add_argument("-o", "--output", metavar="REPORT", help="a .md or .json file to write the report to")
    add_where(stress)

    render = command(
        "render",
        "render",
        "render a scene, or compare two pictures",
        "examples:\n"
        "  sssgen render scenes/lantern.toml -o lantern.png\n"
        "  sssgen render --compare lantern.png golden.png -o difference.png",
    )
    render.add_argument("SCENE", nargs="?", help="a scene's .toml file, or an example")
    render.add_argument("-o", "--output", metavar="FILE", help="a .png or .exr; default: SCENE's name and .png")
    render.add_argument(
        "--backend", "-b", metavar="NAME", default="gl", help="gl (default), webgpu, browser, hlsl, numpy, …"
    )
    render.add_argument("--guards", choices=GUARDS, default="auto", help=GUARDS_HELP)
    render.add_argument("--size", metavar="WxH", help="in pixels, instead of the scene's own")
    render.add_argument("--time", type=float, metavar="T", help="in seconds, instead of the scene's own")
    render.add_argument("--compare", nargs=2, metavar=("A", "B"), help="FLIP, relMSE, p99 and max of A against B")

    ci = command(
        "ci",
        "ci",
        "check a folder: compile its materials, compare its scenes with golden pictures, run its numbers",
        "examples:\n"
        "  sssgen ci shaders --junit report.xml\n"
        "  sssgen ci shaders --update\n"
        "A scene's golden picture is golden/NAME.png beside it. A file NAME.eval.json has numbers: "
        '{"technique": "lobe_gdc2011", "inputs": {"N": [[0, 0, 1]]}, "tolerance": 1e-5}',
    )
    ci.add_argument("DIR", help="the folder of your materials and scenes")
    ci.add_argument(
        "--backend", "-b", metavar="NAME", help="or several, with commas; default: gl for scenes, all here for numbers"
    )
    ci.add_argument("--update", action="store_true", help="write the golden pictures, instead of comparing with them")
    ci.add_argument("--flip", type=float, metavar="X", help="the largest mean of FLIP that passes (default: 0.005)")
    ci.add_argument("--junit", metavar="FILE", help="write a report in JUnit's XML")

    _measuring(command)
    add_baking(command, add_where)

    new = command("new", "new", "write a commented material to start from")
    new.add_argument("MATERIAL", help="its name, or a .toml file; an old one is never overwritten")
    return top


def _measuring(command: Callable[..., argparse.ArgumentParser]) -> None:
    """The commands that measure error and cost."""
    chart = command(
        "chart",
        "chart",
        "chart error against cost: every technique and every published baseline, on scenes",
        "examples:\n"
        "  sssgen chart cube torus -o charts\n"
        "  sssgen chart my/scene.toml --role thickness --json\n"
        "A scene says in [medium] what its body is made of. Without one: our own scenes (examples/lab).",
    )
    chart.add_argument("SCENE", nargs="*", help="a scene's .toml file, or one of ours")
    chart.add_argument("-o", "--output", metavar="DIR", help="the folder for PNG, SVG, HTML, CSV and JSON")
    chart.add_argument("--role", metavar="R,R", help="coordinates, thickness, translucency, material (default: all)")
    chart.add_argument(
        "--cost", choices=("static", "gpu"), default="static", help="operations counted (default), or time on the GPU"
    )

    pick = command(
        "pick",
        "pick",
        "pick the cheapest chain of techniques that a scene can do with",
        "examples:\n"
        "  sssgen pick cube --max-error 0.5\n"
        "  sssgen pick my/scene.toml --max-cost 300 --emit out --target wgsl\n"
        "From a chart of the scene in the cache it answers at once; else it measures first.",
    )
    pick.add_argument("SCENE", help="a scene's .toml file, or one of ours")
    limits = pick.add_mutually_exclusive_group(required=True)
    limits.add_argument("--max-error", type=float, metavar="E", help="the largest relative error, as 0.3")
    limits.add_argument("--max-cost", type=float, metavar="C", help="the largest static cost, in operations")
    pick.add_argument("--emit", metavar="DIR", help="write the material there, and its shaders")
    pick.add_argument("--target", "-t", metavar="T,T|all", default="glsl-330", help="of --emit (default: glsl-330)")

    fit = command(
        "fit", "fit", "fit a material's parameters to a scene's medium", "example:\n  sssgen fit cube lobe_exp2"
    )
    fit.add_argument("SCENE", help="a scene's .toml file, or one of ours")
    fit.add_argument("TECHNIQUE", nargs="*", help="translucency techniques; all without one")
    for one in (chart, pick, fit):
        one.add_argument(
            "--samples", type=int, default=512, metavar="N", help="of the reference, a pixel (default: 512)"
        )
        one.add_argument("--seed", type=int, default=0, metavar="N", help="of the reference's chance (default: 0)")
        add_where(one)


class _Version(argparse.Action):
    """`--version`, without importing anything for those who do not ask."""

    def __call__(self, *_: object) -> NoReturn:
        from sssgen.version import VERSION

        print(f"sssgen {VERSION}")
        raise SystemExit(0)


def add_where(command: argparse.ArgumentParser) -> None:
    """The options that say where a command's work items run."""
    command.add_argument("--processes", type=_processes, metavar="N", help="share the work out to so many processes")
    command.add_argument(
        "--scheduler", default="", metavar="ADDRESS", help="share it out to a Dask cluster's workers: tcp://HOST:8786"
    )


def _processes(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of processes")
    return int(text)
