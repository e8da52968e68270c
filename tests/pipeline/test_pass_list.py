"""The list of passes, and the trace of their changes."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.cli.main import main
from sssgen.ir.text import print_module, read_module
from sssgen.pipeline import pass_list
from sssgen.pipeline.pass_list import KEPT, MATERIAL, PLAIN, TARGET, Pass


@pytest.mark.parametrize("passes", [MATERIAL, PLAIN, KEPT, TARGET])
def test_a_list_names_each_pass_once_with_its_reason(passes: tuple[Pass, ...]) -> None:
    names = [record.name for record in passes]
    assert len(set(names)) == len(names)
    lines = pass_list.describe(passes).splitlines()
    assert len(lines) == len(passes)
    for record, line in zip(passes, lines, strict=True):
        assert (
            record.name in line and record.reason in line and (record.when is None or f"if {record.when.text}" in line)
        )


def test_the_trace_of_emit_shows_each_pass_that_changed_the_module(tmp_path: Path) -> None:
    command = ["emit", "ice", "--target", "wgsl,numpy", "-o", str(tmp_path)]
    assert main(command) == 0
    untraced = (tmp_path / "ice.wgsl").read_text("utf-8")
    assert not list(tmp_path.glob("*.trace"))
    for _ in range(2):  # the second run uses the caches and has the same trace
        assert main([*command, "--trace"]) == 0
        files = sorted((tmp_path / "ice.wgsl.trace").iterdir())
        names = [path.name for path in files]
        assert names[:4] == ["01-link.ir", "02-chain.ir", "03-shell.ir", "04-fold.ir"] and names[-1].endswith(
            "-names.ir"
        )
        (tmp_path / "ice.wgsl.trace" / "99-old.ir").write_text("of an earlier run", "utf-8")
    assert (tmp_path / "ice.wgsl").read_text("utf-8") == untraced
    assert any(path.name.endswith("-masks.ir") for path in (tmp_path / "ice.numpy.trace").iterdir())
    for path in files:
        text = path.read_text("utf-8")
        assert text.startswith(f"// {path.stem[3:]}: ")
    fold = (tmp_path / "ice.wgsl.trace" / "04-fold.ir").read_text("utf-8")
    assert fold.partition("\n\n")[2] == print_module(read_module(fold), spans=False)


def test_the_trace_lists_what_is_drawn_before(tmp_path: Path) -> None:
    assert main(["emit", "jade_ring", "--target", "wgsl", "-o", str(tmp_path), "--trace"]) == 0
    for path in (tmp_path / "jade_ring.wgsl.trace").iterdir():
        lines = [line for line in path.read_text("utf-8").splitlines() if line.startswith("// drawn before: ")]
        assert lines == [
            "// drawn before: back_faces, the body from eye, to back_face_map",
            "// drawn before: distant_light_depth, the body from distant light, to light_depth_map",
        ]


def test_the_trace_of_a_failure_ends_before_the_pass_that_failed(tmp_path: Path) -> None:
    source = tmp_path / "f.glsl"
    text = "struct S { float a, b; };\nuniform S s[2];\nint n() { return 1; }\nS f() { return s[n()]; }\n"
    source.write_text(text, "utf-8")
    command = ["transpile", str(source), "--target", "wgsl", "-o", str(tmp_path / "f.wgsl"), "--trace"]
    assert main(command) == 2
    assert [path.name for path in (tmp_path / "f.wgsl.trace").iterdir()] == ["00-input.ir"]
    assert not (tmp_path / "f.wgsl").exists()


def test_the_trace_of_transpile_needs_an_output_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "f.glsl"
    source.write_text("float f(float x) { return x; }\n", "utf-8")
    for output in ([], ["-o", "-"]):
        assert main(["transpile", str(source), "--target", "wgsl", "--trace", *output]) == 2
        assert "--trace needs an output file" in capsys.readouterr().err
