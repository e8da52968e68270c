"""Work items: every executor gives the same bytes and runs each item once, even if processes die."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from executor_items import GATE, items, open_gate, runs
from folders import TESTS
from processes import HANG, enable_interrupts, wait_until
from slow_cases import some_slow
from sssgen.analyse.stress.stress_items import run_stress
from sssgen.analyse.stress.stress_report import Report, as_json
from sssgen.analyse.stress.stress_run import Machines, Settings, stress
from sssgen.analyse.stress.subject import specimens
from sssgen.cli import main as cli
from sssgen.jobs import dask_cluster as cluster
from sssgen.jobs import work_items as work
from sssgen.jobs.executor import Failure, Item, failures, run
from sssgen.jobs.result_store import Store
from sssgen.jobs.work_items import execute, task_of
from sssgen.support.diagnostics import SssgenError
from sssgen.support.progress import ProgressBar
from sssgen.support.value_bytes import decode, encode


@pytest.fixture(autouse=True)
def current_stamps() -> None:
    """The source files may change while the tests run; then only the current test fails."""
    work.code_stamp.cache_clear()
    work._package_digest.cache_clear()


def test_a_worker_with_other_code_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    task = task_of(Item("executor_items:echo", (1,), "the item"))
    assert decode(execute(task)) == (1, 1)
    monkeypatch.setattr(work, "code_stamp", lambda module: "another")
    refused = decode(execute(task))
    assert isinstance(refused, Failure) and "another version of sssgen" in refused.message


def as_bytes(results: list[Any]) -> list[bytes]:
    assert not failures(results), failures(results)
    return [encode(result) for result in results]


def test_results_do_not_depend_on_processes(tmp_path: Path) -> None:
    jobs = items(tmp_path, 6)
    results = run(jobs, processes=0, store=Store(""))
    assert [result.name for result in results] == [f"item {number}" for number in range(6)]
    assert as_bytes(run(jobs, processes=2, store=Store(""))) == as_bytes(results)
    assert runs(tmp_path) == sorted([*range(6)] * 2)


def test_bytes_depend_only_on_values() -> None:
    grid = np.arange(6.0).reshape(2, 3)
    text = "".join(["one", "two"])
    fixed = grid.copy()
    fixed.flags.writeable = False
    assert encode((text, text)) == encode(("onetwo", "".join(["onet", "wo"])))
    assert encode(grid.T) == encode(np.ascontiguousarray(grid.T)) != encode(grid)
    assert encode(np.asfortranarray(grid)) == encode(grid) == encode(fixed)
    assert encode(decode(encode(grid.T))) == encode(grid.T)
    cycle: list[Any] = []
    cycle.append(cycle)
    with pytest.raises(ValueError, match="cyclic"):
        encode(cycle)


def test_keys() -> None:
    item = Item("executor_items:echo", (1,), "one")
    assert task_of(item).key == task_of(item._replace(name="another name")).key
    remaining = [item._replace(arguments=(2,)), item._replace(function="executor_items:fail")]
    remaining += [item._replace(function="sssgen.support.progress:ProgressBar")]
    assert len({task_of(other).key for other in [item, *remaining]}) == 4


def test_duplicates_run_once(tmp_path: Path) -> None:
    jobs = items(tmp_path, 3)
    results = run([*jobs, *jobs], processes=2, store=Store(""))
    assert runs(tmp_path) == [0, 1, 2]
    assert as_bytes(results[:3]) == as_bytes(results[3:])


def test_stored_results_are_not_recomputed(tmp_path: Path) -> None:
    store, notes = Store(str(tmp_path / "store")), tmp_path / "runs"
    notes.mkdir()
    first = run(items(notes, 3), processes=0, store=store)
    messages: list[tuple[int, int, str]] = []
    again = run(items(notes, 4), processes=0, store=store, progress=lambda *event: messages.append(event))
    assert runs(notes) == [0, 1, 2, 3]
    assert as_bytes(again[:3]) == as_bytes(first)
    assert messages == [(number + 1, 4, f"item {number}") for number in range(4)]


def test_damaged_entries_are_recomputed(tmp_path: Path) -> None:
    store, notes = Store(str(tmp_path / "store")), tmp_path / "runs"
    notes.mkdir()
    first = run(items(notes, 2), processes=0, store=store)
    path = next(path for path in (tmp_path / "store").rglob("*") if path.is_file())
    path.write_bytes(path.read_bytes()[:-1])
    assert as_bytes(run(items(notes, 2), processes=0, store=store)) == as_bytes(first)
    assert len(runs(notes)) == 3


def test_without_a_cache_folder_results_stay_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sssgen.support.cache._folder", "")
    store = Store()
    run([Item("executor_items:echo", (1,))], processes=0, store=store)
    assert not store.folder and len(store.memory) == 1


@pytest.mark.parametrize("processes", [0, 2])
def test_a_failure_affects_only_its_item(processes: int) -> None:
    jobs = [Item("executor_items:fail", (how,), how) for how in ("said", "raised", "exit")]
    jobs += [Item("executor_items:missing", (), "missing"), Item("no_such_module:name", (), "module")]
    jobs += [Item("executor_items:echo", (1,), "good")]
    store = Store("")
    *failed, good = run(jobs, processes=processes, store=store)
    assert good == (1, 1)
    assert [failure.name for failure in failed] == ["said", "raised", "exit", "missing", "module"]
    assert (failed[0].message, failed[0].hint) == ("the scene has no light", "add one")
    assert failed[1].message.startswith("ValueError: no such thing (executor_items.py:")
    assert "no_such_module" in failed[4].message
    assert len(store.memory) == 1  # failed items are run again


def test_items_of_a_killed_process_are_repeated(tmp_path: Path) -> None:
    jobs = [*items(tmp_path, 3, name="die_first"), *items(tmp_path, 6)[3:]]
    results = run(jobs, processes=2, store=Store(""))
    assert results[:3] == [0, 1, 2] and not failures(results)
    assert runs(tmp_path) == [0, 0, 1, 1, 2, 2, 3, 4, 5]


def test_an_item_that_kills_every_process_is_named(tmp_path: Path) -> None:
    deadly, good = Item("executor_items:die", (str(tmp_path), 7), "the seventh"), Item("executor_items:echo", (1,))
    assert run([deadly, good], processes=2, store=Store("")) == [
        Failure("the seventh", "its process crashed (SIGKILL), 3 times in a row"),
        (1, 1),
    ]
    assert runs(tmp_path) == [7, 7, 7]


def test_an_interrupt_without_processes_keeps_finished_items() -> None:
    store = Store("")
    with pytest.raises(KeyboardInterrupt):
        run([Item("executor_items:interrupted", (number,)) for number in range(5)], processes=0, store=store)
    assert len(store.memory) == 2


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_an_interrupted_run_continues(tmp_path: Path, how: int) -> None:
    notes, folder = tmp_path / "runs", tmp_path / "store"
    notes.mkdir()
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS / "tools"), *filter(None, sys.path)])}
    code = "import sys, executor_items; executor_items.run_behind_gate(*sys.argv[1:])"
    command = [sys.executable, "-c", code, str(notes), str(folder)]
    process = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL, preexec_fn=enable_interrupts)

    def stored_files() -> list[Path]:
        return [path for path in folder.rglob("*") if path.is_file() and path.suffix != ".tmp"]

    def at_the_gate() -> bool:
        return len(stored_files()) == GATE and len(runs(notes)) == GATE + 2

    wait_until(lambda: at_the_gate() or process.poll() is not None, "the items before the gate")
    assert process.poll() is None
    process.send_signal(how)
    assert process.wait(timeout=HANG) != 0
    open_gate(notes)
    assert len(stored_files()) == GATE  # both workers were at the gate
    jobs = items(notes, 12, "measure_behind_gate")
    results = run(jobs, processes=2, store=Store(str(folder)))
    assert len(runs(notes)) == 12 + 2  # the two at the gate ran twice; no worker continued after the interrupt
    assert as_bytes(results) == as_bytes(run(jobs, processes=0, store=Store(str(folder))))


def test_the_bar_is_silent_without_a_terminal(capfd: pytest.CaptureFixture[str]) -> None:
    with ProgressBar() as progress_bar:
        run([Item("executor_items:echo", (1,))], processes=0, store=Store(""), progress=progress_bar)
    assert capfd.readouterr() == ("", "")


def test_bar_on_a_terminal(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("rich")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("sssgen.support.progress.DELAY", 0.0)
    with ProgressBar() as progress:
        progress(3, 4, "cube [one]")
    output = capsys.readouterr()
    assert not output.out and "3/4" in output.err and "cube [one]" in output.err


def test_no_bar_without_rich(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setitem(sys.modules, "rich.console", None)
    monkeypatch.setattr("sssgen.support.progress.DELAY", 0.0)
    with ProgressBar() as progress:
        progress(3, 4, "cube")
    assert capsys.readouterr() == ("", "")


@pytest.fixture
def dask() -> Iterator[Any]:
    """A scheduler and two workers, in separate processes; new for each test, as workers keep their `code_stamp`."""
    distributed = pytest.importorskip("distributed")
    import dask

    path = os.pathsep.join([str(TESTS / "tools"), *filter(None, sys.path)])
    with (
        dask.config.set({"distributed.worker.memory.terminate": False, "distributed.scheduler.allowed-failures": 3}),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, env={"PYTHONPATH": path}
        ) as local,
    ):
        yield local


@pytest.mark.filterwarnings("default")
def test_results_on_dask_survive_a_dead_worker(tmp_path: Path, dask: Any) -> None:
    local, remote = tmp_path / "local", tmp_path / "remote"
    for folder in (local, remote):
        folder.mkdir()
    expected = as_bytes(run(items(local, 4), processes=0, store=Store("")))
    assert as_bytes(run([*items(local, 4), *items(local, 2)], dask.scheduler_address, store=Store(""))) == [
        *expected,
        *expected[:2],
    ]
    assert runs(local) == sorted([*range(4)] * 2)

    jobs = [*items(remote, 12, name="measure_behind_gate"), Item("executor_items:fail", ("said",), "said")]
    store, killed = Store(str(tmp_path / "store")), []

    def kill(finished: int, total: int, name: str) -> None:
        if finished == 3:
            killed.append(next(iter(dask.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)
            open_gate(remote)

    *results, failed = run(jobs, dask.scheduler_address, store=store, progress=kill)
    assert killed and failed == Failure("said", "the scene has no light", "add one")
    assert [result.name for result in results] == [f"item {number}" for number in range(12)]
    assert set(runs(remote)) == set(range(12))
    assert as_bytes(results) == as_bytes(run(jobs[:-1], processes=0, store=Store("")))
    assert len([path for path in (tmp_path / "store").rglob("*") if path.is_file()]) == 12


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_an_item_that_kills_every_dask_worker_is_named(tmp_path: Path, dask: Any) -> None:
    deadly = Item("executor_items:die", (str(tmp_path), 7), "the seventh")
    (failed,) = run([deadly], dask.scheduler_address, store=Store(""))
    assert failed.name == "the seventh" and "KilledWorker" in failed.message
    assert runs(tmp_path) == [7] * 4
    assert run([Item("executor_items:echo", (1,))], dask.scheduler_address, store=Store("")) == [(1, 1)]


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("runner", some_slow(["processes", "dask"], "processes"))
def test_distributed_stress_gives_the_same_results(
    runner: str, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    scheduler = request.getfixturevalue("dask").scheduler_address if runner == "dask" else ""
    missing = ["browser"] if runner == "processes" else []
    monkeypatch.setenv("SSSGEN_CHROMIUM", "/nowhere/chromium")
    chosen, names = specimens(["resin_inlay", "ice_shader_lobe"]), ["numpy-f32", *missing]
    settings = Settings(samples=500)
    with Machines(names) as machines:
        rows = [stress(specimen, machines, settings) for specimen in chosen]
        alone = Report(settings, {"numpy-f32": machines.backends["numpy-f32"].device()}, machines.missing, rows)
    shared = run_stress(chosen, names, settings, scheduler, None if scheduler else 2)
    assert without_times(shared) == without_times(alone)
    assert len(shared.rows) == len(chosen) > 2 and [*shared.missing] == missing


def without_times(report: Report) -> str:
    return re.sub(r'"seconds": [0-9.e-]+', "", json.dumps(as_json(report)))


@pytest.mark.filterwarnings("default")
def test_no_scheduler(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "SECONDS", 0.5)
    for address in ("tcp://127.0.0.1:9", "nonsense://x:y"):
        with pytest.raises(SssgenError, match="no Dask scheduler answers"):
            run([Item("executor_items:echo", (1,))], address, store=Store(""))
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(SssgenError, match=r"\[cluster\]"):
        run([Item("executor_items:echo", (1,))], "tcp://127.0.0.1:9", store=Store(""))


def test_the_command_distributes_its_items(capsys: pytest.CaptureFixture[str]) -> None:
    command = ["stress", "lobe_normalized", "--backend", "numpy-f32", "--samples", "100"]
    assert cli.main(command) == 0
    alone = capsys.readouterr().out
    assert cli.main([*command, "--processes", "2"]) == 0
    times = re.compile(r"in [0-9.]+ s, [0-9.]+ million a second")
    assert times.sub("", capsys.readouterr().out) == times.sub("", alone)
    assert cli.main([*command, "--processes", "0"]) == 2
    assert "'0' is not a number of processes" in capsys.readouterr().err


def test_the_stamp_is_of_the_whole_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a module imports from its own package changes the results, too."""
    package = tmp_path / "stamped"
    package.mkdir()
    for name in ("__init__", "runs", "texts"):
        (package / f"{name}.py").write_text("VALUE = 1\n", "utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    before = work.code_stamp.__wrapped__("stamped.runs")
    (package / "texts.py").write_text("VALUE = 2\n", "utf-8")
    assert work.code_stamp.__wrapped__("stamped.runs") != before
