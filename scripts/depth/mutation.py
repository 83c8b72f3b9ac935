"""Mutants of the decision code, the isolation rule and every cell of the transition table against what must notice them.

Called by scripts/mutate, which builds what this links with.
"""
import argparse
import json
import os
import pathlib
import random
import re
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from queue import Queue

import mutants
import oracles
import reviewed
import table

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = ROOT / "tests/mutation/survivors.txt"
KEYS = ("file", "function", "line", "change", "kind", "reason")
GATE = 0.95
RESOURCES = "/usr/lib/llvm-19/lib/clang/19"  # the headers that come with the compiler


def everything():
    arguments = ["-std=c++17", "-DPLUMB_CAPACITY=8", f"-I{ROOT / 'include'}", "-isystem", "/usr/include/eigen3",
                 "-fno-exceptions", "-fno-rtti", "-resource-dir", RESOURCES]
    return [*mutants.sources(ROOT, arguments), *table.cells(ROOT)]


class Results:
    """What is known already; every new verdict is written down at once. A verdict counts for the objects it was found with
    (`tree`); after a change the test that killed a mutant is asked before all others, which is nearly always enough."""

    def __init__(self, path, tree, kept_over_changes):
        self.path, self.tree, self.known, self.last = path, tree, {}, {}
        for text in path.read_text().splitlines() if path.exists() else []:
            record = json.loads(text)
            same, settled = record["tree"] == self.tree, record["verdict"] in ("killed", "equivalent", "stillborn")
            if (settled and kept_over_changes) or (same and not kept_over_changes):
                self.known[record["key"]] = record
            self.last[record["key"]] = record
        path.write_text("".join(json.dumps(record) + "\n" for record in self.last.values()))

    def hint(self, mutant):
        return self.last[mutant.key]["by"].rpartition(": ")[2] if mutant.key in self.last else None

    def note(self, mutant, verdict, by, seconds):
        record = {"key": mutant.key, "tree": self.tree, "file": mutant.file, "function": mutant.function,
                  "number": mutant.number, "line": mutant.line, "change": mutant.change, "operator": mutant.operator,
                  "verdict": verdict, "by": by, "seconds": round(seconds, 2)}
        self.known[mutant.key] = record
        with self.path.open("a") as out:
            out.write(json.dumps(record) + "\n")


def judge_all(todo, workshop, results, workers, deadline):
    free = Queue()
    for worker in range(workers):
        free.put(f"worker_{os.getpid()}_{worker}")

    def one(mutant):
        if time.monotonic() > deadline:
            return
        name = free.get()
        begin = time.monotonic()
        try:
            verdict, by = workshop.judge(mutant, name, results.hint(mutant))
        finally:
            free.put(name)
        results.note(mutant, verdict, by, time.monotonic() - begin)
        if verdict == "survived":
            print(f"survived: {mutant.file}:{mutant.number} {mutant.change}", flush=True)

    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(one, todo))


def verdict_of(chosen, whole, results):
    """Compares with the list that was read; prints what counts; true if the gate holds."""
    listed = {"|".join(e[k] for k in ("file", "function", "line", "change")): e for e in reviewed.entries(LIST, KEYS)}
    wrong = [f"no such mutant any more: {name}" for name in listed.keys() - {m.identity for m in whole}]
    counts = {"killed": 0, "survived": 0, "equivalent": 0, "stillborn": 0}
    by = {}
    for mutant in chosen:
        record, entry = results.known[mutant.key], listed.get(mutant.identity)
        verdict = record["verdict"]
        if verdict == "survived" and entry is not None and entry["kind"] == "equivalent":
            verdict = "equivalent"
        elif verdict == "survived" and entry is None:
            wrong.append(f"survived and not in the list: {mutant.file}:{mutant.number}, {mutant.function}, "
                         f"`{mutant.line}`: {mutant.change}")
        elif verdict == "killed" and entry is not None:
            wrong.append(f"in the list and killed by {record['by']}: {mutant.identity}")
        counts[verdict] += 1
        if verdict == "killed":
            oracle = record["by"].split(":")[0]
            by[oracle] = by.get(oracle, 0) + 1
    n = counts["killed"] + counts["survived"]
    if n == 0 or counts["killed"] < GATE * n:
        wrong.append(f"fewer than {GATE:.0%} killed")
    for text in wrong:
        print(text)
    print("killed by: " + ", ".join(f"{name} {number}" for name, number in sorted(by.items(), key=lambda x: -x[1])))
    figure = (f"{reviewed.share(counts['killed'], n)} killed, {counts['equivalent']} equivalent, "
              f"{counts['stillborn']} stillborn, of {len(whole)}")
    print(f"figure: {figure}")
    (ROOT / "build/mutation/summary.json").write_text(json.dumps({
        "schema": 1, "of": len(whole), "judged": len(chosen), **counts, "killed_by": by, "holds": not wrong, "wrong": wrong,
        "figure": figure, "mutants": [results.known[m.key] for m in chosen]}, indent=1) + "\n")
    return not wrong


def main():
    parser = argparse.ArgumentParser(prog="scripts/mutate", description=__doc__.splitlines()[0])
    parser.add_argument("--sample", type=int, help="so many of them, drawn by --seed")
    parser.add_argument("--seed", type=int, default=20180227)
    parser.add_argument("--only", default="", help="mutants whose file, function, line or change this pattern meets")
    parser.add_argument("--again", action="store_true", help="after a change: keep what was killed, judge the survivors again")
    parser.add_argument("--fresh", action="store_true", help="forget the results of earlier runs")
    parser.add_argument("--minutes", type=float, default=1e9, help="stop then; the next call goes on")
    parser.add_argument("--oracles", type=int, default=3, choices=(1, 2, 3),
                        help="quick tests; and laws; and longer tests: --again then gives the survivors to all of them")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--build", default="build/mutants", help="whose objects are linked with")
    options = parser.parse_args()

    whole = everything()
    chosen = [m for m in whole if re.search(options.only, m.identity)]
    random.Random(options.seed).shuffle(chosen)
    if options.sample is not None:
        chosen = chosen[:options.sample]
    workshop = oracles.Workshop(ROOT, ROOT / options.build, options.oracles)
    store = workshop.work / "results.jsonl"
    if options.fresh:
        store.unlink(missing_ok=True)
    results = Results(store, workshop.prepare(), options.again)
    todo = [m for m in chosen if m.key not in results.known]
    print(f"{len(whole)} mutants, {len(chosen)} asked for, {len(todo)} to judge", flush=True)
    if any(workshop.needs_tests(m) for m in todo):
        workshop.baseline()
        print("without a mutant: " + ", ".join(f"{len(tests)} {stage} {sum(map(workshop.seconds.get, tests)):.1f} s"
                                               for _, tests, stage in workshop.asked), flush=True)
    if todo:
        judge_all(todo, workshop, results, options.jobs, time.monotonic() + 60 * options.minutes)
    left = [m for m in chosen if m.key not in results.known]
    if left:
        print(f"{len(left)} are left: call it again")
        chosen = [m for m in chosen if m.key in results.known]
    return verdict_of(chosen, whole, results) and not left


if __name__ == "__main__":
    sys.exit(0 if main() else 1)
