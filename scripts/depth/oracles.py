"""What must notice a mutant: the compiler, the specification, the tests.

The tests are linked once, with every source that has mutants in a shared library of its own: a mutant costs the compilation
of one source to such a library, which stands before the original where the loader looks.
"""
import hashlib
import json
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import time
from collections import Counter

import table

COMPILER = "clang++-19"
TESTS = {"RC_PARAMS": "seed=20180227 max_success=100 noshrink=1", "PLUMB_LAW_CASES": "200", "LLVM_PROFILE_FILE": "/dev/null"}
# What is asked: of the core's tests the rooms that know decisions, without those that measure rates of false alarms or
# damage every bit (long, and not about decisions); the laws without the one that needs more cases.
PROGRAMS = {
    "core": "*:-FalseAlarm*:FittedFalseAlarm*:Threshold*:ForgedFields*:BitFlips*:Snapshot.EverySingle*:SnapshotLaw*:Rounding*:"
            "ExactSum*",
    "law": "*:-Law.Five*",
}
QUICK_s = 0.02  # tests that take no longer are asked before all others, and so are those that notice most
NOTICE_MOST = ("IsolationOracle.", "Induction.", "Decision.")
INDUCTION = ("tests/health/induction_test.cpp", "tests/health/transition_table_test.cpp",
             "tests/health/decision_test.cpp")
# The sources that have mutants, and the tests that compile a changed header themselves: each is a library of its own.
APART = ("src/health/decision.cpp", "src/health/transition_table.cpp", "src/health/serve_event.cpp", "src/health/diagnosis.cpp",
         "src/detection/isolation.cpp", "src/detection/norm_mismatch_doubt.cpp", *INDUCTION)
# Where a changed header is compiled anew; all else that reads it keeps the original.
READERS = {
    "include/plumb/health/detail/decision.hpp": ("src/health/decision.cpp", *INDUCTION),
    "include/plumb/health/transition_table.hpp": ("src/health/decision.cpp", "src/health/transition_table.cpp", *INDUCTION),
    "include/plumb/detection/isolation.hpp": ("src/detection/isolation.cpp",),
    "include/plumb/detection/detail/norm_mismatch_doubt.hpp": ("src/detection/isolation.cpp", "src/detection/norm_mismatch_doubt.cpp"),
}
RESULT = re.compile(r"^\[  (     OK|FAILED ) \] ([\w/.]+).* \((\d+) ms\)$", re.M)
BEGUN = re.compile(r"^\[ RUN      \] ([\w/.]+)$", re.M)


class Killed(Exception):
    """By which oracle."""


class Stillborn(Exception):
    """Is no program."""


def run(command, environment, seconds, cwd):
    """Exit status and output; None for one that ran out of time: the whole group is ended with it."""
    child = subprocess.Popen(command, cwd=cwd, env={**os.environ, **environment}, text=True, errors="replace",
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        text, _ = child.communicate(timeout=seconds)
        return child.returncode, text
    except subprocess.TimeoutExpired:
        return None, ""
    finally:
        try:
            os.killpg(child.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        child.wait()


def library_of(file):
    return file.replace("/", "_").removesuffix(".cpp")


class Workshop:
    """Builds and judges, from the objects of a build that is complete."""

    def __init__(self, root, build, stages=3):
        self.root, self.build, self.used = root, build, stages
        self.work = root / "build/mutation"
        self.originals = self.work / "originals"
        self.work.mkdir(parents=True, exist_ok=True)
        self.commands = {}
        for entry in json.loads((build / "compile_commands.json").read_text()):
            words = shlex.split(entry["command"])
            target = words[words.index("-o") + 1].split(".dir/")[0]
            self.commands[entry["file"], target.rsplit("/", 1)[-1]] = words
        folder = build / "CMakeFiles"
        apart = {f"{file}.o" for file in APART}

        def objects(target):
            below = folder / f"{target}.dir"
            return sorted(o for o in below.rglob("*.o") if str(o.relative_to(below)) not in apart)

        library = objects("plumb_8")
        core = [o for o in objects("plumb_core_tests") if o.parent.name in ("health", "detection")]
        self.objects = {"core": [*core, *library], "law": [*objects("plumb_law_objects"), *library]}
        self.original = {}   # the objects of the unchanged sources
        self.seconds = {}    # of every test, without a mutant
        self.program_of = {}
        self.asked = ()      # (program, tests, stage), in order
        self.killers = {}    # which tests have killed mutants of a function: asked first
        self.same = {}       # verdicts by object

    # --- building ----------------------------------------------------------------------------------------------------
    def compile(self, file, room, source=None, shadow=None):
        """The object of `file`, with `source` in its place or with a folder of changed headers before all others."""
        entry = self.commands[str(self.root / file), "plumb_core_tests" if file.startswith("tests/") else "plumb_8"]
        options = [w for w in entry if w.startswith(("-D", "-I", "-std", "-f"))
                   and not w.startswith(("-fpch", "-fprofile", "-fcoverage"))]
        systems = [w for i, w in enumerate(entry) if w == "-isystem" or entry[i - 1] == "-isystem"]
        out = room / f"{library_of(file)}.o"
        first = [f"-I{shadow}"] if shadow else []
        speed = ["-O2"]
        if file.startswith("tests/"):  # what they take longest to read is the headers of the test library
            parsed = self.originals / "gtest.pch"
            speed = ["-O1", "-include-pch", str(parsed)]
            if not parsed.exists():
                run([COMPILER, *options, *systems, "-O1", "-fPIC", "-DNDEBUG", "-w", "-x", "c++-header",
                     "/usr/include/gtest/gtest.h", "-o", str(parsed)], {}, 300, room)
        command = [COMPILER, *first, *options, *systems, f"-I{(self.root / file).parent}", *speed, "-fPIC", "-DNDEBUG", "-w",
                   "-c", str(source or self.root / file), "-o", str(out)]
        status, text = run(command, {}, 300, room)
        if status != 0:
            if "static assertion failed" in text or "static_assert" in text:
                raise Killed("static_assert")
            raise Stillborn(text[-2000:])
        return out

    def to_library(self, made, room):
        """What it defines it uses itself, inline functions too: a changed header is not overruled by the program's."""
        out = room / f"lib{made.stem}.so"
        command = [COMPILER, "-shared", "-Wl,-Bsymbolic", "-fuse-ld=lld", str(made), "-o", str(out)]
        status, text = run(command, {}, 60, room)
        if status != 0:
            raise Stillborn(text[-2000:])

    def link(self):
        """The tests, with the original libraries."""
        for program, objects in self.objects.items():
            apart = [f for f in APART if program == "core" or not f.startswith("tests/")]
            libraries = ["-lrapidcheck", "-lgmock", "-lgtest", "-lgtest_main", "-lpthread"]
            command = [COMPILER, "-fuse-ld=lld", "-rdynamic", "-o", str(self.work / program), *map(str, objects), *libraries,
                       "-Wl,--no-as-needed", f"-L{self.originals}", *(f"-l{library_of(f)}" for f in apart)]
            status, text = run(command, {}, 300, self.work)
            if status != 0:
                raise SystemExit(f"mutate: the tests cannot be linked: {text[-2000:]}")

    # --- what is known without a mutant ------------------------------------------------------------------------------
    def prepare(self):
        """The originals and the programs; what it returns changes with everything that a verdict depends on."""
        shutil.rmtree(self.originals, ignore_errors=True)
        self.originals.mkdir()
        room = self.room(f"original_{os.getpid()}")
        digest = hashlib.sha256()
        for file in APART:
            made = self.compile(file, room, source=self.place(file, (self.root / file).read_bytes(), room))
            self.original[file] = made.read_bytes()
            self.to_library(made, self.originals)
            digest.update(self.original[file])
        shutil.rmtree(room)
        self.link()
        for objects in self.objects.values():
            for path in objects:
                digest.update(path.read_bytes())
        asserted = table.asserted(self.root)
        (self.originals / "specification.cpp").write_text(asserted)
        digest.update(asserted.encode())
        for file in (*READERS, *INDUCTION):
            digest.update((self.root / file).read_bytes())
        digest.update(repr((PROGRAMS, TESTS)).encode())
        return digest.hexdigest()

    def baseline(self):
        """Nothing changed: every oracle must be content. Then the tests stand in order, the quick ones first."""
        for program, pattern in PROGRAMS.items():
            status, text = self.ask(program, pattern, 600, self.work)
            if status != 0:
                raise SystemExit(f"mutate: without any mutant: {text[-3000:]}")
            for _, test, milliseconds in RESULT.findall(text):
                self.seconds[test], self.program_of[test] = int(milliseconds) / 1000, program
        core = [t for t, program in self.program_of.items() if program == "core"]
        quick = [t for t in core if self.seconds[t] <= QUICK_s or t.startswith(NOTICE_MOST)]
        law = [t for t in self.program_of if t not in core]
        self.asked = (("core", quick, "quick tests"), ("law", law, "laws"),
                      ("core", [t for t in core if t not in quick], "longer tests"))

    # --- judging -----------------------------------------------------------------------------------------------------
    def ask(self, program, pattern, seconds, room):
        """Seconds of the processor, for others use this machine too."""
        environment = {**TESTS, "LD_LIBRARY_PATH": f"{room}:{self.originals}"}
        return run(["prlimit", f"--cpu={math.ceil(seconds)}", str(self.work / program), f"--gtest_filter={pattern}",
                    "--gtest_fail_fast"], environment, 60 + 20 * seconds, room)

    def stage(self, program, tests, name, room):
        if not tests:
            return
        status, text = self.ask(program, ":".join(tests), 3 + 5 * sum(self.seconds[t] for t in tests), room)
        if status == 0:
            return
        failed = [test for result, test, _ in RESULT.findall(text) if result.startswith("FAILED")] or BEGUN.findall(text)[-1:]
        how = "out of time" if status in (None, -signal.SIGXCPU, 128 + signal.SIGXCPU) else f"status {status}"
        raise Killed(f"{name}: {failed[0]}" if failed else f"{name}: {how}")

    def known_killers(self, mutant, hint):
        """Tests that have killed this mutant before a change, or others of its function and file."""
        def place(whole):
            return self.killers.setdefault((mutant.file, mutant.function.split(" (")[0] if whole else None), Counter())
        likely = [hint] + [t for t, _ in place(True).most_common(4)] + [t for t, _ in place(False).most_common(3)]
        return [t for t in dict.fromkeys(likely) if t in self.seconds and (t == hint or self.seconds[t] < 0.5)]

    def stages(self, mutant, room, hint):
        likely = self.known_killers(mutant, hint)
        for program in PROGRAMS:
            self.stage(program, [t for t in likely if self.program_of[t] == program], "likely tests", room)
        for program, tests, name in self.asked[:self.used]:
            self.stage(program, tests, name, room)

    def room(self, name):
        room = self.work / name
        shutil.rmtree(room, ignore_errors=True)
        room.mkdir()
        return room

    @staticmethod
    def place(file, source, room):
        path = room / file.rsplit("/", 1)[-1]
        path.write_bytes(source)
        return path

    @staticmethod
    def needs_tests(mutant):
        """The specification judges every cell but those of the event `none`, which it does not have."""
        return mutant.operator != "cell" or mutant.function.endswith("[14]")

    def judge(self, mutant, name, hint=None):
        """killed, survived, equivalent or stillborn, and by what. `hint`: the test that killed it last time."""
        room = self.room(name)
        try:
            verdict = self.verdict_of(mutant, room, hint)
        except Killed as by:
            verdict = "killed", str(by)
        except Stillborn as why:
            verdict = "stillborn", str(why).splitlines()[0] if str(why) else ""
        finally:
            shutil.rmtree(room, ignore_errors=True)
        test = verdict[1].rpartition(": ")[2]
        if verdict[0] == "killed" and test in self.seconds:
            for place in ((mutant.file, mutant.function.split(" (")[0]), (mutant.file, None)):
                self.killers.setdefault(place, Counter())[test] += 1
        return verdict

    def verdict_of(self, mutant, room, hint):
        changed = mutant.apply((self.root / mutant.file).read_bytes())
        if mutant.operator == "cell":
            self.judge_cell(mutant, changed, room)
        if mutant.file in READERS:
            shadow = self.shadow(mutant, changed, room)
            made = {file: self.compile(file, room, source=self.place(file, (self.root / file).read_bytes(), room), shadow=shadow)
                    for file in READERS[mutant.file]}
        else:
            made = {mutant.file: self.compile(mutant.file, room, source=self.place(mutant.file, changed, room))}
        code = {file: path.read_bytes() for file, path in made.items()}
        if all(code[file] == self.original[file] for file in made):
            return "equivalent", "the compiler: the same object"
        digest = hashlib.sha256(b"".join(code.values())).digest()
        if digest not in self.same:
            for path in made.values():
                self.to_library(path, room)
            try:
                self.stages(mutant, room, hint)
                self.same[digest] = "survived", ""
            except Killed as by:
                self.same[digest] = "killed", str(by)
        return self.same[digest]

    def shadow(self, mutant, changed, room):
        path = room / mutant.file
        path.parent.mkdir(parents=True)
        path.write_bytes(changed)
        return room / "include"

    def judge_cell(self, mutant, changed, room):
        """By compilation alone: what the specification says of every cell is asserted at compile time."""
        shadow = self.shadow(mutant, changed, room)
        command = [COMPILER, "-std=c++17", "-DPLUMB_CAPACITY=8", f"-I{shadow}", f"-I{self.root / 'include'}", "-fsyntax-only",
                   "-ferror-limit=0", "-w", str(self.originals / "specification.cpp")]
        status, text = run(command, {}, 120, room)
        shutil.rmtree(room / "include")
        if status == 0:
            return
        failed = re.findall(r"error: static assertion failed[^\n]*", text)
        if any("specification" not in line for line in failed):
            raise Killed("static_assert")
        raise Killed("specification") if failed else Stillborn(text[-2000:])
