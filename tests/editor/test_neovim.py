"""The settings for Neovim in docs/editors.md, run by Neovim itself."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from folders import DOCS

WRONG = (
    "/**\n * A lobe.\n * role: translucency\n */\nfloat own(world_direction N)\n{\n    return clmp(N.x, 0.0, 1.0);\n}\n"
)

SESSION = """
local function wait(name, done)
  assert(vim.wait(60000, done, 50), "waited too long for " .. name)
end
local result = {}
vim.cmd.edit("own.sss")
wait("the error", function() return #vim.diagnostic.get(0) > 0 end)
local problem = vim.diagnostic.get(0)[1]
result.error = { problem.lnum, problem.col, problem.message, problem.source }
vim.api.nvim_buf_set_lines(0, 6, 7, true, { "    return clamp(N.x,   0.0, 1.0);" })
wait("no error", function() return #vim.diagnostic.get(0) == 0 end)
local client = vim.lsp.get_clients({ name = "sssgen" })[1]
local function ask(method, more)
  local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
  local answer = client:request_sync(method, vim.tbl_extend("force", params, more or {}), 60000, 0)
  return answer and (answer.result or answer.err)
end
vim.api.nvim_win_set_cursor(0, { 7, 12 })
result.hover = ask("textDocument/hover").contents.value
result.lens = ask("textDocument/codeLens")[1].command.title
vim.lsp.buf.format({ timeout_ms = 60000 })
result.line = vim.api.nvim_buf_get_lines(0, 6, 7, true)[1]
result.filetype, result.syntax, result.comment = vim.bo.filetype, vim.bo.syntax, vim.bo.commentstring
io.stdout:write(vim.json.encode(result))
"""


def neovim() -> str:
    """The path of a Neovim that has `vim.lsp.config`; '' where there is none."""
    path = shutil.which("nvim") or ""
    version = subprocess.run([path, "--version"], capture_output=True, text=True, check=False).stdout if path else ""
    found = re.match(r"NVIM v0\.(\d+)", version)
    return path if found and int(found[1]) >= 11 else ""


@pytest.mark.slow
@pytest.mark.skipif(not neovim(), reason="Neovim 0.11 or later is missing")
def test_the_settings_of_the_page(tmp_path: Path) -> None:
    page = (DOCS / "editors.md").read_text("utf-8")
    (settings,) = re.findall(r"```lua\n(.*?)```", page, re.DOTALL)
    (tmp_path / "init.lua").write_text(settings, encoding="utf-8")
    (tmp_path / "session.lua").write_text(SESSION, encoding="utf-8")
    (tmp_path / "own.sss").write_text(WRONG, encoding="utf-8")
    program = tmp_path / "bin" / "sssgen"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m sssgen "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    folders = {f"XDG_{name}_HOME": str(tmp_path / name) for name in ("CONFIG", "DATA", "STATE", "CACHE")}
    environment = {**os.environ, **folders, "PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}
    command = [neovim(), "--headless", "-n", "-u", "init.lua", "-c", "luafile session.lua", "-c", "qall!"]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=200, check=False
    )
    assert "Error" not in done.stderr, done.stderr
    result = json.loads(done.stdout)
    assert result["error"] == [6, 11, "unknown function 'clmp'\ndid you mean 'clamp'?", "sssgen"]
    assert "**clamp** (builtin)" in result["hover"]
    assert "operations" in result["lens"]
    assert result["line"] == "    return clamp(N.x, 0.0, 1.0);"
    assert (result["filetype"], result["syntax"], result["comment"]) == ("sss", "glsl", "// %s")
