"""How pages turn surroundings back to the rest pose of a skinned body, against NumPy."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from folders import ROOT
from oracle import close
from relit_cases import write_body
from sssgen.scene.arrays import Array
from sssgen.scene.geometry_base import unit
from sssgen.scene.light_response import from_bytes, harmonics, lit

pytestmark = pytest.mark.skipif(not shutil.which("node"), reason="node is missing (Node.js)")


def turned(surroundings: Array, turn: Array) -> Array:
    """The integrals of light in a space that `turn` brings to that of `surroundings`, by sums over many directions."""
    ways = unit(np.random.default_rng(1).normal(size=(4000, 3)))
    shown = harmonics(ways @ turn.T) @ surroundings
    solved: Array = np.linalg.lstsq(harmonics(ways), shown, rcond=None)[0]
    return solved


def test_surroundings_that_bones_turn(tmp_path: Path) -> None:
    write_body(tmp_path)
    random = np.random.default_rng(0)
    surroundings = random.uniform(-0.3, 0.3, (9, 3))
    surroundings[0] = 2.0
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_rotvec([0.9, -1.3, 0.4]).as_matrix()
    places, others = random.uniform(-1.0, 1.0, (200, 3)), random.uniform(-1.0, 1.0, (500, 3)) * [0.3, 2.0, 1.0]
    given = {
        "surroundings": surroundings.tolist(), "matrix": matrix.T.ravel().tolist(), "places": places.tolist(),
        "others": others.tolist(),
    }  # fmt: skip
    runtime = ROOT / "src" / "sssgen" / "targets" / "javascript"
    command = ["node", str(Path(__file__).with_name("inner_pose.mjs")), runtime.as_uri(), str(tmp_path / "body.bin")]
    ran = subprocess.run(command, input=json.dumps(given), capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    said = json.loads(ran.stdout)
    facts = json.loads((tmp_path / "body.bin.json").read_text("utf-8"))
    response = from_bytes((tmp_path / "body.bin").read_bytes(), facts)
    expected = lit(response, [], turned(surroundings, matrix[:3, :3]))
    drawn = np.array(said["texels"], np.uint16).view(np.float16).reshape(*expected.shape[:3], 4)[..., :3]
    assert expected.std() > 0.05
    close(drawn.astype(float), expected, rtol=2e-3, atol=1e-3)
    distances = np.linalg.norm(places[:, None] - others.astype(np.float32)[None], axis=2)
    assert said["nearest"] == distances.argmin(axis=1).tolist()


def said_by_node(folder: Path, script: str) -> subprocess.CompletedProcess[str]:
    """What a script prints in a folder, with the facts of its bake."""
    module = (ROOT / "src" / "sssgen" / "targets" / "javascript" / "inner_light.js").as_uri()
    before = f"""
        import {{ readFileSync }} from 'node:fs';
        import {{ responseOf }} from '{module}';
        const facts = JSON.parse(readFileSync('body.bin.json', 'utf8'));
    """
    command = ["node", "--input-type=module", "-e", before + script]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_a_page_warns_of_another_body(tmp_path: Path) -> None:
    write_body(tmp_path)
    body = json.loads((tmp_path / "body.bin.json").read_text("utf-8"))["body"]
    larger = [1.1 * value for value in body["box_max"]]
    printed = said_by_node(
        tmp_path,
        f"""
        const response = await responseOf({{ data: readFileSync('body.bin'), facts }});
        response.checkBody({body["box_min"]}, {body["box_max"]});
        console.warn('now');
        response.checkBody({body["box_min"]}, {larger});
        """,
    ).stderr
    before, after = printed.split("now")
    assert not before and "baked for another body: body.ply is from (" in after, printed


@pytest.mark.parametrize("entry", ["bytes", "adler32"])
def test_a_page_refuses_the_json_of_another_bake(entry: str, tmp_path: Path) -> None:
    write_body(tmp_path)
    sidecar = tmp_path / "body.bin.json"
    facts = json.loads(sidecar.read_text("utf-8"))
    facts["file"][entry] += 1
    sidecar.write_text(json.dumps(facts), "utf-8")
    ran = said_by_node(tmp_path, "await responseOf({ data: readFileSync('body.bin'), facts });")
    assert ran.returncode != 0 and "body.bin.json is the JSON of another bake" in ran.stderr, ran.stderr
