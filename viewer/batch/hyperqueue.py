"""Submits tasks of a batch to HyperQueue and waits for them: what viewer/batch/hyperqueue.cpp runs.

argv: a JSON file with server_dir, workers (cores of each worker to start with an own server; none = the server runs),
command (words) and tasks ([indices, cores, gpus, megabytes] each; cores 0 = all).
Exit codes: 0 the job ended, 1 the server was lost or refused, 4 the package hyperqueue is missing.
"""

import json
import os
import sys

try:
    from hyperqueue import Client, Job, LocalCluster
    from hyperqueue.cluster import WorkerConfig
    from hyperqueue.ffi.protocol import ResourceRequest
except ImportError as missing:
    print(f"lightwell: {missing}", file=sys.stderr)
    sys.exit(4)


def request(cores, gpus, megabytes):
    resources = {}
    if gpus:
        resources["gpus/nvidia"] = gpus
    if megabytes:
        resources["mem"] = megabytes
    return ResourceRequest(cpus=cores or "all", resources=resources)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        call = json.load(file)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # the server prints a table
    if call["workers"]:
        cluster = LocalCluster(server_dir=call["server_dir"])
        for cores in call["workers"]:
            cluster.start_worker(WorkerConfig(cores=cores))
    client = Client(call["server_dir"] or None)
    job = Job(max_fails=None, name=call["name"])
    for indices, *resources in call["tasks"]:
        job.program(
            call["command"] + [str(i) for i in indices],
            stdout=None,
            stderr=None,
            resources=request(*resources),
            crash_limit=call["crash_limit"],
        )
    submitted = client.submit(job)
    if not call["workers"]:
        print(f"submitted to HyperQueue as job {submitted.id}", file=sys.stderr, flush=True)
    if client.connection.wait_for_jobs([submitted.id], lambda jobs: None):
        for context in client.get_failed_tasks(submitted).values():
            if "exit code 1." not in context.error:  # the journal of the batch has those
                print(f"lightwell: HyperQueue: {context.error}", file=sys.stderr)
    sys.stderr.flush()
    os._exit(0)  # the server and its workers end with this process


main()
