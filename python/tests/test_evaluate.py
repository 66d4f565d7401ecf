"""Packed cases give the report of `partsight evaluate`, to the bit, with Ray and without, whatever is killed."""

import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Optional

import pytest
from conftest import CHECKOUT, require
from test_same_as_program import program

import partsight
from partsight import evaluate

PARTS = CHECKOUT / "reference_parts"


def simulate(folder: Path, *arguments: str) -> None:
    command: list[str | Path] = [program(), "simulate", "--cases", folder, "--placement", "facing", *arguments]
    subprocess.run(command, check=True, capture_output=True)


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Eleven cases: nine of parts and one of a box, of which two are damaged, and one of a newer version."""
    require("pyarrow")
    folder = tmp_path_factory.mktemp("kept") / "cases"
    simulate(folder, "--part", "fender,grille,front_door", "--num", "9", "--seed", "40")
    simulate(folder, "--part", "box", "--num", "1", "--seed", "40", "--difficulty", "unknown")
    names = sorted(case.name for case in folder.iterdir() if case.is_dir())
    scene = folder / names[1] / "scene.png"
    content = bytearray(scene.read_bytes())
    content[9000] ^= 1
    scene.write_bytes(content)
    (folder / names[5] / "case.toml").write_text("schema_version = 1")
    shutil.copytree(folder / names[7], folder / "newer")
    (folder / "newer" / "case.toml").write_text("schema_version = 99")
    return folder


class Expected:
    """What the program reports of these cases."""

    def __init__(self, kept: Path) -> None:
        path = kept.parent / "evaluated.json"
        options: list[str | Path] = ["--library", PARTS, "--recipe", "built-in", "--threads", "1", "--json", path]
        command: list[str | Path] = [program(), "evaluate", kept, *options]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        # Cases are damaged.
        assert ran.returncode == 2, ran.stderr
        self.record = without_times(path.read_text())
        self.lines = lines_without_times(ran.stdout)
        assert self.record["tally"]["total"] == "8" and len(self.record["damaged"]) == 3

    def check(self, report: evaluate.Report) -> None:
        assert without_times(report.json) == self.record
        assert lines_without_times(report.text) == self.lines


def without_times(text: str) -> dict[str, Any]:
    # Numbers stay the digits that they were written with.
    record: dict[str, Any] = json.loads(text, parse_float=str, parse_int=str)
    del record["times_ms"], record["num_threads"]
    for case in record["cases"]:
        del case["total_ms"]
    return record


def lines_without_times(text: str) -> list[str]:
    lines = text.rstrip("\n").split("\n")
    start = next(place for place, line in enumerate(lines) if line.startswith("Time per stage"))
    return [*lines[:start], *lines[start + 8 :]]


@pytest.fixture(scope="module")
def expected(kept: Path) -> Expected:
    return Expected(kept)


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Four workers on this machine, and none once these tests are done: Ray's threads would run beside the other tests."""
    require("ray")
    import ray

    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    # The worker processes find the tests beside the package.
    environment = {"env_vars": {"PYTHONPATH": str(Path(__file__).parent)}}
    ray.init(num_cpus=4, include_dashboard=False, runtime_env=environment, object_store_memory=100_000_000)
    ray.data.DataContext.get_current().enable_progress_bars = False
    yield ray
    ray.shutdown()


def packed(kept: Path, to: Path, batch_size: int = 1) -> Path:
    assert evaluate.pack(kept, to, batch_size=batch_size) == 11
    return to


def parts(results: Path) -> dict[str, int]:
    """The results of batches, with the times at which they were written."""
    return {path.name: path.stat().st_mtime_ns for path in (results / "parts").glob("*.parquet")}


@pytest.mark.filterwarnings("ignore:the kept case")
@pytest.mark.parametrize("batch_size", [1, 4, 100])
def test_the_report_is_that_of_the_program_for_any_size_of_batches(
    kept: Path, expected: Expected, tmp_path: Path, batch_size: int
) -> None:
    cases = packed(kept, tmp_path / "cases", batch_size)
    report = evaluate.run(cases, tmp_path / "results", PARTS)
    expected.check(report)
    assert (tmp_path / "results" / "report.json").read_text() == report.json
    # Wherever the cases were: their folder is not looked at again, and a URI names the same store.
    again = evaluate.run(cases.as_uri(), (tmp_path / "again").as_uri(), PARTS)
    expected.check(again)
    tables = [(tmp_path / name / "results.parquet").read_bytes() for name in ("results", "again")]
    assert tables[0] == tables[1]


@pytest.mark.filterwarnings("ignore:the kept case")
def test_each_case_that_cannot_be_read_is_a_warning(kept: Path, tmp_path: Path) -> None:
    cases = packed(kept, tmp_path / "cases")
    with pytest.warns(UserWarning, match="its checksum") as warned:
        evaluate.run(cases, tmp_path / "results", PARTS)
    assert len(warned) == 3


@pytest.mark.filterwarnings("ignore:the kept case")
@pytest.mark.parametrize("workers", [1, 2, 4])
def test_the_report_is_that_of_the_program_for_any_number_of_workers(
    cluster: Any, kept: Path, expected: Expected, tmp_path: Path, workers: int
) -> None:
    cases = packed(kept, tmp_path / "cases", batch_size=2)
    report = evaluate.run_on_ray(cases, tmp_path / "results", PARTS, workers=workers)
    expected.check(report)
    assert json.loads(report.json)["num_threads"] == workers


def test_the_example_evaluates_and_goes_on_where_it_was(cluster: Any, kept: Path, expected: Expected, tmp_path: Path) -> None:
    environment = {**os.environ, "RAY_ADDRESS": cluster.get_runtime_context().gcs_address}
    example = CHECKOUT / "python" / "examples" / "evaluate_on_ray.py"
    command: list[str | Path] = [sys.executable, "-W", "ignore", example, kept, tmp_path / "store", PARTS, "2"]
    for is_first in (True, False):
        ran = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
        assert ran.returncode == 0, ran.stderr
        first, _, text = ran.stdout.partition("\n")
        assert (first == "11 cases packed") == is_first
        assert lines_without_times(text if is_first else ran.stdout) == expected.lines


class KilledOnce(evaluate._Judge):
    """A worker that is killed in the middle of the run, once: before the results of its batch are written, or after."""

    folder = Path()
    after_writing = False

    def judge(self, batch: evaluate._Batch) -> None:
        before = parts(self.folder)
        is_time = batch.group >= 5
        if is_time and self.after_writing:
            super().judge(batch)
        try:
            if is_time:
                with open(self.folder / "killed.json", "x") as file:
                    json.dump([os.getpid(), before], file)
                os.kill(os.getpid(), signal.SIGKILL)
        except FileExistsError:
            pass
        if not (is_time and self.after_writing):
            super().judge(batch)


@pytest.mark.filterwarnings("ignore:the kept case")
@pytest.mark.parametrize("after_writing", [False, True])
def test_a_killed_worker_loses_nothing(
    cluster: Any,
    kept: Path,
    expected: Expected,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    after_writing: bool,
) -> None:
    cases, results = packed(kept, tmp_path / "cases"), tmp_path / "results"
    killed = type("Killed", (KilledOnce,), {"folder": results, "after_writing": after_writing})
    monkeypatch.setattr(evaluate, "_Judge", killed)
    expected.check(evaluate.run_on_ray(cases, results, PARTS, workers=2))
    pid, before = json.loads((results / "killed.json").read_text())
    assert pid != os.getpid()
    # What was written before is there, and was not computed again.
    after = parts(results)
    assert before.items() <= after.items() and len(after) == 11
    assert not list((results / "parts").glob("*.tmp")) and not list((results / "parts").glob(".*"))


class AlwaysKilled(evaluate._Judge):
    """A worker that one of the batches kills each time."""

    def judge(self, batch: evaluate._Batch) -> None:
        if batch.group == 4:
            os.kill(os.getpid(), signal.SIGKILL)
        super().judge(batch)


class Unfit(evaluate._Judge):
    """A worker on a machine with another library."""

    def __init__(self, cases: str, results: str, library: Optional[str], recipe: partsight.Recipe, expected: dict[str, Any]) -> None:
        super().__init__(cases, results, library, recipe, {**expected, "library": "00000000"})


@pytest.mark.filterwarnings("ignore:the kept case")
def test_a_case_that_kills_every_worker_ends_the_run_and_is_named(
    cluster: Any, kept: Path, expected: Expected, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cases, results = packed(kept, tmp_path / "cases"), tmp_path / "results"
    with monkeypatch.context() as patch:
        patch.setattr(evaluate, "_Judge", AlwaysKilled)
        with pytest.raises(partsight.PartsightError, match="5 workers were killed at the cases [a-z_0-9]+\n"):
            evaluate.run_on_ray(cases, results, PARTS, workers=2)
    # The rest of the run can still be had.
    before = parts(results)
    expected.check(evaluate.run_on_ray(cases, results, PARTS, workers=2))
    assert before.items() <= parts(results).items()


def test_a_worker_with_another_library_ends_the_run(
    cluster: Any, kept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evaluate, "_Judge", Unfit)
    with pytest.raises(partsight.PartsightError, match="has another library"):
        evaluate.run_on_ray(packed(kept, tmp_path / "cases"), tmp_path / "results", PARTS, workers=2)


@pytest.mark.filterwarnings("ignore:the kept case")
def test_a_run_that_was_killed_goes_on_where_it_ended(kept: Path, expected: Expected, tmp_path: Path) -> None:
    cases, results = packed(kept, tmp_path / "cases"), tmp_path / "results"
    script = """if True:
        import os, signal, sys
        from partsight import evaluate
        judge = evaluate._Judge.judge
        def killed(self, batch):
            if batch.group == 6:
                stream, _ = self.results.open_new("parts/half")
                stream.write(b"PAR1")
                stream.flush()
                os.kill(os.getpid(), signal.SIGKILL)
            judge(self, batch)
        evaluate._Judge.judge = killed
        evaluate.run(*sys.argv[1:])
    """
    ran = subprocess.run([sys.executable, "-c", script, cases, results, PARTS], check=False)
    assert ran.returncode == -signal.SIGKILL
    before = parts(results)
    assert len(before) == 6 and not (results / "report.json").exists()
    expected.check(evaluate.run(cases, results, PARTS))
    assert before.items() <= parts(results).items()
    # And once more: nothing is left to be done, and the report is the same.
    before = parts(results)
    expected.check(evaluate.run(cases, results, PARTS))
    assert before == parts(results) and len(before) == 11


@pytest.mark.filterwarnings("ignore:the kept case")
def test_results_that_cannot_be_read_are_computed_again(kept: Path, expected: Expected, tmp_path: Path) -> None:
    cases, results = packed(kept, tmp_path / "cases"), tmp_path / "results"
    evaluate.run(cases, results, PARTS)
    damaged = sorted((results / "parts").iterdir())
    damaged[0].write_bytes(b"")
    damaged[1].write_bytes(damaged[1].read_bytes()[:-7])
    expected.check(evaluate.run(cases, results, PARTS))


def test_results_of_another_recipe_or_library_are_not_mixed(kept: Path, tmp_path: Path) -> None:
    cases, results = packed(kept, tmp_path / "cases", batch_size=100), tmp_path / "results"
    with pytest.warns(UserWarning):
        evaluate.run(cases, results, PARTS)
    strict = partsight.Recipe({"accept.min_score": 1.0})
    with pytest.raises(partsight.PartsightError, match=r"another run \(recipe\)"):
        evaluate.run(cases, results, PARTS, strict)
    shutil.copytree(PARTS / "fender", tmp_path / "parts" / "fender")
    with pytest.raises(partsight.PartsightError, match=r"another run \(library\)"):
        evaluate.run(cases, results, tmp_path / "parts")
    # A worker on a machine with another library, too.
    arguments = evaluate._Run(cases, results, PARTS, None).judge_arguments()
    judge = evaluate._Judge(arguments[0], arguments[1], str(tmp_path / "parts"), arguments[3], arguments[4])
    with pytest.raises(partsight.PartsightError, match="has another library"):
        assert judge.library


def test_what_cannot_be_run_is_said_in_words(kept: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(partsight.PartsightError, match="there are no cases"):
        evaluate.pack(tmp_path / "empty", tmp_path / "cases")
    with pytest.raises(partsight.PartsightError, match="no packed cases"):
        evaluate.run(tmp_path / "cases", tmp_path / "results", PARTS)
    packed(kept, tmp_path / "cases")
    with pytest.raises(partsight.PartsightError, match="holds packed cases"):
        evaluate.pack(kept, tmp_path / "cases")


def test_what_killed_writers_left_is_removed_from_every_folder_of_a_store() -> None:
    require("pyarrow")
    # Unlike a local folder, this store refuses a path with an empty name in it.
    store = evaluate._Store("mock:///cases")
    for folder in ("", "parts"):
        stream, temporary = store.open_new(f"{folder}/half".lstrip("/"))
        with stream:
            stream.write(b"PAR1")
        assert store.names(folder) == [os.path.basename(temporary)]
        store.clear(folder)
        assert store.names(folder) == []


class Overtaken(evaluate._Judge):
    """A worker whose batch another one does meanwhile, and removes the notes of its tries."""

    def judge(self, batch: evaluate._Batch) -> None:
        for name in self.results.names("tries"):
            self.results.fs.delete_file(self.results.at(f"tries/{name}"))


def test_notes_of_tries_that_another_worker_removed_are_no_error(tmp_path: Path) -> None:
    require("pyarrow")
    worker = Overtaken(str(tmp_path / "cases"), str(tmp_path / "results"), None, partsight.Recipe(), {})
    batch = {"file": ["cases-00000.parquet"], "group": [0]}
    assert worker(batch) == batch


def test_a_pickled_recipe_has_the_same_parameters_and_name() -> None:
    recipe = partsight.Recipe({"accept.min_score": 1 / 3, "segment.plane_distance": 12.345678901})
    again = pickle.loads(pickle.dumps(recipe))
    assert (again.name, again.identity) == (recipe.name, recipe.identity)
