"""The jobs of a batch for Dask, Ray and other engines of Python.

    from vantage import batch
    jobs = batch.items("films.csv", "results", preset="realtime", threads=4)
    client.gather(client.map(batch.process, jobs))                   # Dask
    ray.get([ray.remote(batch.process).remote(job) for job in jobs])  # Ray

The work is done by the program: all machines need `vantage` in their PATH.
"""

from __future__ import annotations

import json as _json
import os as _os
import pathlib as _pathlib
import shutil as _shutil
import subprocess as _subprocess
import tempfile as _tempfile
from typing import Any

from vantage import Error, UsageError

__all__ = ["items", "process"]

_EXIT_USAGE = 2
_EXIT_FAILED_ITEMS = 3


def items(manifest: str | _os.PathLike[str], output: str | _os.PathLike[str],
          **options: Any) -> list[dict[str, Any]]:
    """The jobs of a batch, each a plain dict for process().

    options: those of `vantage batch` that hold for all items, with _ in place of -, as texts or
    numbers of the command line; True gives a flag, a list gives an option several times.

    Returns dicts of `words` (the command's), `core_seconds` and `memory_bytes` (estimates). Paths
    are absolute: all machines must see them. Raises UsageError for wrong options or a wrong
    manifest, Error where the program is missing or fails.
    """
    words = [_place(manifest), f"--output={_place(output)}"]
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        values = value if isinstance(value, list) else [value]
        words += [option if one is True else f"{option}={one}"
                  for one in values if one is not False]
    jobs = _run([*words, "--dry-run"])["jobs"]
    return [{"words": [*words, f"--index={number}/{len(jobs)}"],
             "core_seconds": job["core_seconds"], "memory_bytes": job["memory_bytes"]}
            for number, job in enumerate(jobs, 1)]


def process(item: dict[str, Any]) -> dict[str, Any]:
    """Does a job of items(), or what is left of it; returns the results of its report.

    Pure: it depends on the item and on files alone, and a second call finds all done. May be called
    by any process and thread. Raises Error where the job is not finished and should be tried again,
    UsageError where that would be in vain. Items that failed for good are no exception:
    `items_failed` counts them.
    """
    return _run(item["words"])


def _place(path: str | _os.PathLike[str]) -> str:
    text = _os.fspath(path)
    return text if "://" in text else _os.path.abspath(text)


def _run(words: list[str]) -> dict[str, Any]:
    """The results in the report of a batch."""
    program = _shutil.which("vantage")
    if program is None:
        raise Error("the program vantage is not in the PATH, expected it there on all machines")
    with _tempfile.TemporaryDirectory() as folder:
        report = _pathlib.Path(folder) / "report.json"
        done = _subprocess.run([program, "batch", *words, "--quiet", f"--report={report}"],
                               stdin=_subprocess.DEVNULL, capture_output=True, text=True,
                               check=False)
        if done.returncode not in (0, _EXIT_FAILED_ITEMS):
            lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
            raise (UsageError if done.returncode == _EXIT_USAGE else Error)(lines[-1])
        results: dict[str, Any] = _json.loads(report.read_text(encoding="utf-8"))["results"]
        return results
