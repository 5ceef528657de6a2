"""Jobs of a batch, as engines of Python take them."""

import os
import pickle

import pytest
from conftest import PROGRAM, run_program

import vantage
from vantage import batch

PRESETS = ("realtime", "balanced", "quality")  # pairs with different options are different jobs


@pytest.fixture
def manifest(scene, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}")
    file = tmp_path / "films.csv"
    file.write_text("output,left,right,preset\n" + "".join(
        f"{preset},{scene}/left.png,{scene}/right.png,{preset}\n" for preset in PRESETS))
    return file


def maps(folder):
    return [(folder / preset / "disparity.pfm").read_bytes() for preset in PRESETS]


def test_workers_of_dask_make_what_the_program_makes(manifest, tmp_path):
    distributed = pytest.importorskip("distributed")
    run_program("batch", manifest, "-o", tmp_path / "whole", "--disparities", "0:15")
    jobs = batch.items(manifest, tmp_path / "results", disparities="0:15", threads=1)
    assert len(jobs) == len(PRESETS)
    assert all(job["core_seconds"] > 0 and job["memory_bytes"] > 0 for job in jobs)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1",
                                  dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        client.gather(client.map(batch.process, jobs))
    assert maps(tmp_path / "results") == maps(tmp_path / "whole")


def test_a_job_is_a_plain_dict_and_finds_done_what_is_done(manifest, tmp_path):
    jobs = pickle.loads(pickle.dumps(batch.items(manifest, tmp_path / "results", keep_going=True)))
    for _ in range(2):
        for job in jobs:
            batch.process(job)
    times = [(tmp_path / "results" / preset / "disparity.pfm").stat().st_mtime_ns for preset in PRESETS]
    batch.process(jobs[0])
    assert times == [(tmp_path / "results" / preset / "disparity.pfm").stat().st_mtime_ns
                     for preset in PRESETS]


def test_errors_say_whether_trying_again_helps(manifest, tmp_path, monkeypatch):
    with pytest.raises(vantage.UsageError, match="unknown option '--presett'"):
        batch.items(manifest, tmp_path / "results", presett="quality")
    (tmp_path / "films.csv").write_text("output,left,right\na,absent.png,absent.png\n")
    job, = batch.items(manifest, tmp_path / "results")
    assert batch.process(job)["items_failed"] == 1
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(vantage.Error, match="vantage is not in the PATH"):
        batch.process(job)
