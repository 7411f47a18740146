"""Tasks on a HyperQueue server and workers that live as long as this process.

    local_cluster.py --directory DIR --workers W --cpus C --task-cpus T --crash-limit L --tasks 0,3,4 \\
        -- COMMAND...

Runs COMMAND once for each number, which it finds in HQ_TASK_ID. Exit status: 0 all tasks ended, well or not (what they
left says how), 3 HyperQueue could not go on. The engine keeps its files in DIR. Knows nothing of pontoon.
"""

import argparse
import logging
import signal
import sys

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest


def main():
    parser = argparse.ArgumentParser()
    for name in ("workers", "cpus", "task-cpus", "crash-limit"):
        parser.add_argument(f"--{name}", type=int, required=True)
    parser.add_argument("--directory", required=True)
    parser.add_argument("--tasks", required=True, type=lambda text: [int(number) for number in text.split(",")])
    parser.add_argument("command", nargs="+")
    asked = parser.parse_args()

    with LocalCluster(asked.directory) as cluster:
        for _ in range(asked.workers):
            cluster.start_worker(WorkerConfig(cores=asked.cpus))
        # the engine's own handler would end the workers and wait for them for ever; tasks end with this process
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        job = Job(max_fails=None, default_workdir=asked.directory)
        for number in asked.tasks:
            task = job.program(
                asked.command,
                stdout=None,
                stderr=None,
                resources=ResourceRequest(cpus=asked.task_cpus),
                crash_limit=asked.crash_limit,
            )
            # the engine tells a task its number, and it counts from 0 where none is given
            task.task_id = number
        client = cluster.client()
        submitted = client.submit(job)
        client.connection.wait_for_jobs([submitted.id], lambda jobs: None)
        for task, failed in sorted(client.get_failed_tasks(submitted).items()):
            logging.warning("shard %d: %s", task, failed.error)


if __name__ == "__main__":
    logging.basicConfig(format="hyperqueue: %(message)s")
    try:
        main()
    except Exception as error:  # the engine's errors have no type of their own
        logging.error("%s", error)
        sys.exit(3)
