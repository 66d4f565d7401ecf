"""`partsight evaluate` over many kept cases, on several machines with Ray Data, or in this process.

`pack` copies kept cases into Parquet files on a store that all machines reach: a shared folder, or a URI that pyarrow opens,
such as `s3://bucket/cases`. `run_on_ray` shares them among workers, each of which loads the library once; `run` does the
same in this process. Both give the report of `partsight evaluate`, with the same numbers to the bit, for any number of
workers and size of batches, because the program's own code makes each result and the report.

The results of a batch are a file of their own, written before the next batch begins. A killed worker is replaced and does
its batch again; after a run that ended, the same call does what is missing.

Needs `pip install "partsight[ray]"`, on every machine.
"""

import hashlib
import importlib
import json
import os
import socket
import uuid
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

from . import _partsight
from ._partsight import Library, PartsightError, Recipe

__all__ = ["Report", "pack", "run", "run_on_ray"]

_Where = Union[str, "os.PathLike[str]"]

_SCHEMA = 1
_MANIFEST = "cases.json"
_RUN = "run.json"
_PARTS = "parts"
# A file of cases is closed once it is larger.
_FILE_BYTES = 128 << 20
_TRIES = "tries"
# Workers that a batch may cost before the run ends: killed ones are replaced, but a case may be what kills them.
_MOST_TRIES = 5

_CASE_COLUMNS = {
    "number": "int64",
    "case": "string",
    "truth": "string",
    "truth_part": "string",
    "difficulty": "string",
    "case_toml": "string",
    "scene_file": "string",
    "scene": "binary",
    "empty_cell": "binary",
    "damage": "string",
    "newer_schema": "uint32",
}
_RESULT_COLUMNS = {
    "number": "int64",
    "case": "string",
    "difficulty": "string",
    "truth": "string",
    "truth_part": "string",
    "judgement": "string",
    "part": "string",
    "score": "float64",
    "margin": "float64",
    "accepted": "bool",
    "reason": "string",
    "reason_kind": "string",
    "rotation_error_rad": "float64",
    "shift_error_m": "float64",
    "camera_from_part": "list<float64>",
    "reference": "string",
    "rms_m": "float64",
    "overlap": "float64",
    "shift_bound_m": "float64",
    "turn_bound_rad": "float64",
    "damage": "string",
    "newer_schema": "uint32",
}
_STAGES = ("segment", "project", "contour", "signature", "rank", "pose", "total")
# What no other run repeats.
_TIME_COLUMNS = {**{f"{stage}_ns": "uint64" for stage in _STAGES}, "worker": "string"}


@dataclass(frozen=True)
class Report:
    """What `partsight evaluate` reports: `json` as it writes with `--json`, `text` as it shows."""

    json: str
    text: str


class _Batch(NamedTuple):
    """A row group of a file of cases."""

    file: str
    group: int

    @property
    def part(self) -> str:
        return f"{Path(self.file).stem}-{self.group:05}.parquet"


def _needed(module: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError as error:
        name = module.partition(".")[0]
        message = f'{name} is not installed\n  to do: pip install "partsight[ray]"'
        raise PartsightError(message) from error


class _Store:
    """A folder, local or of a URI."""

    def __init__(self, where: _Where) -> None:
        fs = _needed("pyarrow.fs")
        # Absolute, so that it means the same to a worker.
        self.where = where if isinstance(where, str) and "://" in where else os.path.abspath(where)
        self.fs, self.path = fs.FileSystem.from_uri(self.where)
        self._is_local = isinstance(self.fs, fs.LocalFileSystem)

    def at(self, name: str) -> str:
        return f"{self.path}/{name}"

    def names(self, folder: str = "") -> list[str]:
        fs = _needed("pyarrow.fs")
        selector = fs.FileSelector(self.at(folder).rstrip("/"), allow_not_found=True)
        return sorted(info.base_name for info in self.fs.get_file_info(selector) if info.is_file)

    def exists(self, name: str) -> bool:
        found = self.fs.get_file_info(self.at(name)).type
        return bool(found != _needed("pyarrow.fs").FileType.NotFound)

    def clear(self, folder: str, ending: str = ".tmp") -> None:
        """Removes what writers left that were killed."""
        for name in self.names(folder):
            if name.endswith(ending):
                self.remove(f"{folder}/{name}".lstrip("/"))

    def remove(self, name: str) -> None:
        """Removes a file, unless another worker has done so already."""
        with suppress(FileNotFoundError):
            self.fs.delete_file(self.at(name))

    def open_new(self, name: str) -> tuple[Any, str]:
        """A stream to a temporary file, and its path."""
        self.fs.create_dir(os.path.dirname(self.at(name)), recursive=True)
        temporary = f"{os.path.dirname(self.at(name))}/.{uuid.uuid4().hex}.tmp"
        return self.fs.open_output_stream(temporary), temporary

    def finish(self, temporary: str, name: str) -> None:
        """Gives a closed temporary file its name: there is all of it, or nothing."""
        if self._is_local:
            with open(temporary, "rb") as written:
                os.fsync(written.fileno())
        self.fs.move(temporary, self.at(name))

    def write(self, name: str, content: bytes) -> None:
        stream, temporary = self.open_new(name)
        with stream:
            stream.write(content)
        self.finish(temporary, name)

    def write_table(self, name: str, table: Any) -> None:
        parquet = _needed("pyarrow.parquet")
        stream, temporary = self.open_new(name)
        with stream:
            parquet.write_table(table, stream, compression="zstd", write_page_checksum=True)
        self.finish(temporary, name)

    def parquet(self, name: str) -> Any:
        parquet = _needed("pyarrow.parquet")
        return parquet.ParquetFile(self.at(name), filesystem=self.fs, page_checksum_verification=True)

    def read_json(self, name: str) -> Any:
        """`None` where there is no such file."""
        if not self.exists(name):
            return None
        with self.fs.open_input_stream(self.at(name)) as stream:
            found = json.loads(stream.read())
        if found.get("schema") != _SCHEMA:
            schema = found.get("schema")
            raise PartsightError(f"{self.at(name)}: schema {schema}, expected {_SCHEMA}\n  to do: Use the version that wrote it")
        return found


def _schema(columns: dict[str, str]) -> Any:
    arrow = _needed("pyarrow")
    types = {"list<float64>": arrow.list_(arrow.float64())}
    return arrow.schema([(name, types.get(kind) or arrow.type_for_alias(kind)) for name, kind in columns.items()])


def _table(rows: list[dict[str, Any]], columns: dict[str, str]) -> Any:
    return _needed("pyarrow").Table.from_pylist(rows, schema=_schema(columns))


def pack(folder: _Where, to: _Where, *, batch_size: int = 32) -> int:
    """Copies the kept cases in `folder` into Parquet files in the empty folder `to`; answers with their number.

    A worker inspects `batch_size` cases at a time. Cases that cannot be read are copied as such, and reported by each run.
    """
    if batch_size < 1:
        raise PartsightError(f"a batch of {batch_size} cases\n  to do: Give 1 or more")
    parquet = _needed("pyarrow.parquet")
    store = _Store(to)
    if store.read_json(_MANIFEST) is not None:
        raise PartsightError(f"{store.where} holds packed cases\n  to do: Choose another folder")
    kept = _partsight.KeptCases(folder)
    store.clear("")
    files: list[dict[str, Any]] = []
    digest = hashlib.sha256()
    start = 0
    while start < len(kept):
        name = f"cases-{len(files):05}.parquet"
        groups: list[int] = []
        stream, temporary = store.open_new(name)
        with stream:
            options = {"compression": "zstd", "use_dictionary": False, "write_page_checksum": True}
            with parquet.ParquetWriter(stream, _schema(_CASE_COLUMNS), **options) as writer:
                while start < len(kept) and stream.tell() < _FILE_BYTES:
                    numbers = range(start, min(start + batch_size, len(kept)))
                    rows = [{"number": number, **kept.row(number)} for number in numbers]
                    for row in rows:
                        _add_to(digest, row)
                    writer.write_table(_table(rows, _CASE_COLUMNS), row_group_size=batch_size)
                    groups.append(len(rows))
                    start = numbers.stop
        store.finish(temporary, name)
        files.append({"file": name, "groups": groups})
    manifest = {"schema": _SCHEMA, "num_cases": len(kept), "identity": digest.hexdigest()[:16], "files": files}
    # Last: without it the packing was interrupted.
    store.write(_MANIFEST, json.dumps(manifest, indent=2).encode())
    return len(kept)


def _add_to(digest: Any, row: dict[str, Any]) -> None:
    for value in row.values():
        content = value if isinstance(value, bytes) else repr(value).encode()
        digest.update(len(content).to_bytes(8, "little"))
        digest.update(content)


def _build() -> str:
    """The same for the same build of the package: another one may give other numbers."""
    return hashlib.sha256(Path(str(_partsight.__file__)).read_bytes()).hexdigest()[:16]


class _Judge:
    """Inspects batches of cases by a library that is loaded once. Ray has one in each worker."""

    def __init__(self, cases: str, results: str, library: Optional[str], recipe: Recipe, expected: dict[str, Any]) -> None:
        self.cases, self.results = _Store(cases), _Store(results)
        self.library_path, self.recipe, self.expected = library, recipe, expected
        self.worker = f"{socket.gethostname()}:{os.getpid()}"

    # With the first batch: Ray takes an error there for the worker's own, and one before for a machine that failed.
    @cached_property
    def library(self) -> Library:
        library = Library.open(self.library_path, recipe=self.recipe)
        found = {"library": library.identity, "recipe": self.recipe.identity, "build": _build()}
        for what, identity in found.items():
            if identity != self.expected[what]:
                message = f"{self.worker} has another {what}: {identity}, not {self.expected[what]}"
                raise PartsightError(f"{message}\n  to do: Give all machines the same package and the same library")
        return library

    def judge(self, batch: _Batch) -> None:
        """Writes the results of a batch."""
        rows = self.cases.parquet(batch.file).read_row_group(batch.group).to_pylist()
        judged = _partsight.judge_cases(rows, self.library, self.recipe)
        results = []
        for row, result in zip(rows, judged):
            times = {f"{stage}_ns": took for stage, took in (result.pop("times") or {}).items()}
            results.append({"number": row["number"], **result, **times, "worker": self.worker})
        table = _table(results, {**_RESULT_COLUMNS, **_TIME_COLUMNS})
        self.results.write_table(f"{_PARTS}/{batch.part}", table)

    def __call__(self, batch: dict[str, Any]) -> dict[str, Any]:
        """As Ray calls it. A batch that was done before its worker was killed is not done again."""
        for file, group in zip(batch["file"], batch["group"]):
            asked = _Batch(str(file), int(group))
            if self.results.exists(f"{_PARTS}/{asked.part}"):
                continue
            tried = self._note_try(asked)
            self.judge(asked)
            for name in tried:
                self.results.remove(name)
        return batch

    def _note_try(self, batch: _Batch) -> list[str]:
        """Writes down that a batch begins, and answers with the notes of all its tries."""
        names = [f"{_TRIES}/{batch.part}.{number}" for number in range(_MOST_TRIES)]
        for number, name in enumerate(names):
            if not self.results.exists(name):
                self.results.write(name, self.worker.encode())
                return names[: number + 1]
        cases = self.cases.parquet(batch.file).read_row_group(batch.group, columns=["case"])["case"].to_pylist()
        message = f"{_MOST_TRIES} workers were killed at the cases {', '.join(cases)}"
        raise PartsightError(f"{message}\n  to do: Take away the case that does it, and pack the cases again")


class _Run:
    """What a run needs to know, and what it writes in the end."""

    def __init__(self, cases: _Where, results: _Where, library: Optional[_Where], recipe: Optional[Recipe]) -> None:
        self.cases, self.results = _Store(cases), _Store(results)
        self.recipe = recipe or Recipe()
        self.library = Library.open(library, recipe=self.recipe)
        if not len(self.library):
            raise PartsightError("the library has no part to recognise\n  to do: Enrol a part, or choose another library")
        self.manifest = self.cases.read_json(_MANIFEST)
        if self.manifest is None:
            raise PartsightError(f"{self.cases.where}: there are no packed cases\n  to do: Pack them: partsight.evaluate.pack")
        self.identities = {
            "schema": _SCHEMA,
            "cases": self.manifest["identity"],
            "library": self.library.identity,
            "recipe": self.recipe.identity,
            "build": _build(),
        }
        earlier = self.results.read_json(_RUN)
        if earlier is None:
            self.results.write(_RUN, json.dumps(self.identities, indent=2).encode())
        elif earlier != self.identities:
            others = ", ".join(what for what in self.identities if earlier.get(what) != self.identities[what])
            raise PartsightError(f"{self.results.where} holds results of another run ({others})\n  to do: Choose another folder")

    def judge_arguments(self) -> tuple[Any, ...]:
        library = self.library.path
        return (
            self.cases.where,
            self.results.where,
            None if library is None else os.path.abspath(library),
            self.recipe,
            self.identities,
        )

    def batches(self) -> Iterator[tuple[_Batch, int]]:
        """Every batch with its number of cases."""
        for file in self.manifest["files"]:
            for group, num_cases in enumerate(file["groups"]):
                yield _Batch(file["file"], group), num_cases

    def missing(self) -> list[_Batch]:
        """The batches without results. Results that cannot be read, as after a power failure, count as none."""
        written = set(self.results.names(_PARTS))
        return [batch for batch, num in self.batches() if batch.part not in written or not self._is_whole(batch, num)]

    def _is_whole(self, batch: _Batch, num_cases: int) -> bool:
        try:
            with self.results.parquet(f"{_PARTS}/{batch.part}") as part:
                return bool(part.metadata.num_rows == num_cases)
        except (OSError, _needed("pyarrow").ArrowInvalid):
            self.results.remove(f"{_PARTS}/{batch.part}")
            return False

    def report(self, num_threads: int) -> Report:
        arrow = _needed("pyarrow")
        parts = []
        for batch, _ in self.batches():
            with self.results.parquet(f"{_PARTS}/{batch.part}") as part:
                parts.append(part.read())
        table = arrow.concat_tables(parts).sort_by("number").combine_chunks()
        self.results.write_table("results.parquet", table.select(list(_RESULT_COLUMNS)))
        self.results.write_table("times.parquet", table.select(["number", "case", *_TIME_COLUMNS]))
        rows = table.to_pylist()
        for row in rows:
            row["times"] = None if row["total_ns"] is None else {stage: row[f"{stage}_ns"] for stage in _STAGES}
        text = _partsight.evaluation_report(rows, self.library, self.recipe, num_threads=num_threads)
        report = Report(*text)
        self.results.write("report.json", report.json.encode())
        self.results.write("report.txt", f"{report.text}\n".encode())
        self.results.clear(_PARTS)
        self.results.clear(_TRIES)
        return report


def run(cases: _Where, results: _Where, library: Optional[_Where] = None, recipe: Optional[Recipe] = None) -> Report:
    """Inspects packed cases in this process, one after the other, and writes the results into the folder `results`.

    The library and the recipe are those of `Library.open` and `Recipe`. The folder holds `results.parquet`, a row per case,
    `times.parquet`, `report.json` and `report.txt`; while the run lasts, `parts`. What an earlier run of the same cases,
    library, recipe and build left there is not computed again; any other folder of results is refused.
    """
    prepared = _Run(cases, results, library, recipe)
    missing = prepared.missing()
    if missing:
        judge = _Judge(*prepared.judge_arguments())
        for batch in missing:
            judge.judge(batch)
    return prepared.report(num_threads=1)


def run_on_ray(
    cases: _Where,
    results: _Where,
    library: Optional[_Where] = None,
    recipe: Optional[Recipe] = None,
    *,
    workers: Optional[int] = None,
) -> Report:
    """As `run`, shared among workers of the Ray cluster that this process is connected to, or of one on this machine.

    Without a number of workers there is one for each processor of the cluster. Cases, results and library have to lie where
    every machine finds them under the same path. A worker that is killed is replaced, and its batch is done again.
    """
    prepared = _Run(cases, results, library, recipe)
    missing = prepared.missing()
    # Those of an earlier run do not count.
    prepared.results.clear(_TRIES, "")
    ray, data = _needed("ray"), _needed("ray.data")
    if not ray.is_initialized():
        ray.init()
    workers = workers or max(1, int(ray.cluster_resources().get("CPU", 1)))
    if missing:
        items = [{"file": batch.file, "group": batch.group} for batch in missing]
        # One block for each batch: a worker that is free takes the next. Ray replaces workers that are killed and gives
        # their blocks out again, as often as it takes.
        done = data.from_items(items, override_num_blocks=len(items)).map_batches(
            _Judge,
            fn_constructor_args=prepared.judge_arguments(),
            batch_size=1,
            compute=data.ActorPoolStrategy(size=min(workers, len(items))),
            num_cpus=1,
        )
        try:
            for _ in done.iter_batches(batch_size=None):
                pass
        except ray.exceptions.RayError as error:
            raise PartsightError(f"a worker failed: {error}\n  to do: Once it is mended, start the same run again") from error
    return prepared.report(num_threads=workers)
