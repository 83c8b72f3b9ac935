"""What must notice a mutant: the compiler, the specification, the tests; each mutant in a build of its own."""
import json
import os
import shlex
import shutil
import signal
import subprocess
import time

import table

COMPILER = "clang++-19"
CELLS = table.HEADER
TESTS = {"RC_PARAMS": "seed=20180227 max_success=100 noshrink=1", "LLVM_PROFILE_FILE": "/dev/null"}
# Smallest first. The rooms of tests whose objects go into a program, what is run of it, the environment.
STAGES = (
    ("induction", "core", "Induction.Every*:Induction.F*:Induction.P*:TransitionTable.*", {}),
    ("isolation", "core", "Isolation.*:IsolationLaw.*:OneAttitude*:ReferenceDoubt.*:SetTest*:MirrorAttitudes.*", {}),
    ("requirements", "core", "Requirement*:Episode*:Inhibit*:Patience*:HealthMonitor.*:Snapshot*:Mirror*", {}),
    ("monitor", "core", "MonitorLaw.*:Recalibrating*:FirstCalibration*:HeldAxis*:Attack*:OfferedCalibration*:Probation*", {}),
    ("rates", "core", "IsolationRates.*:Verdict*:ReferenceStudy*:Recalibration*:CommonDrift*:Paper*", {}),
    ("laws", "law", "Law.*:CounterExample.*:-Law.Five*", {"PLUMB_LAW_CASES": "200"}),
)


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


class Workshop:
    """Builds and judges, from the objects of a build that is complete."""

    def __init__(self, root, build, stages=STAGES):
        self.root, self.build, self.used = root, build, stages
        self.work = root / "build/mutation"
        self.work.mkdir(parents=True, exist_ok=True)
        commands = json.loads((build / "compile_commands.json").read_text())
        self.commands = {}
        for entry in commands:
            words = shlex.split(entry["command"])
            target = words[words.index("-o") + 1].split(".dir/")[0]
            self.commands[entry["file"], target.rsplit("/", 1)[-1]] = words
        # A build that counts coverage is as good as another; its programs write no profile here.
        self.counts = any("-fprofile-instr-generate" in words for words in self.commands.values())
        self.core_archive = build / "libplumb_8.a"
        core = sorted((build / "CMakeFiles/plumb_core_tests.dir").rglob("*.o"))
        law = sorted((build / "CMakeFiles/plumb_law_objects.dir").rglob("*.o"))
        # Of the core's tests only the rooms that know decisions: a smaller program is linked sooner.
        self.objects = {"core": [o for o in core if o.parent.name in ("health", "detection")], "law": law}
        self.original = {}
        self.seconds = {}
        self.specified = table.specified(root)

    # --- building ----------------------------------------------------------------------------------------------------
    def compile(self, file, room, source=None, shadow=None):
        """The object of `file`, with `source` in its place or with a folder of changed headers before all others."""
        entry = self.commands[str(self.root / file), "plumb_core_tests" if file.startswith("tests/") else "plumb_8"]
        options = [w for w in entry if w.startswith(("-D", "-I", "-std", "-f"))
                   and not w.startswith(("-fpch", "-fprofile", "-fcoverage"))]
        systems = [w for i, w in enumerate(entry) if w == "-isystem" or entry[i - 1] == "-isystem"]
        out = room / (file.replace("/", "_") + ".o")
        first = [f"-I{shadow}"] if shadow else []
        command = [COMPILER, *first, *options, *systems, f"-I{(self.root / file).parent}", "-O1", "-DNDEBUG", "-w",
                   "-c", str(source or self.root / file), "-o", str(out)]
        status, text = run(command, {}, 300, room)
        if status != 0:
            if "static assertion failed" in text or "static_assert" in text:
                raise Killed("static_assert")
            raise Stillborn(text[-2000:])
        return out

    def link(self, kind, objects, room):
        """The tests with these objects in the place of their own and of the library's."""
        names = {o.name for o in objects}
        rest = [o for o in self.objects[kind] if str(o.relative_to(o.parents[2])).replace("/", "_") not in names]
        out = room / kind
        libraries = ["-lrapidcheck", "-lgmock", "-lgtest", "-lgtest_main", "-lpthread"]
        counting = ["-fprofile-instr-generate"] if self.counts else []
        parts = map(str, [*objects, *rest, self.core_archive])
        command = [COMPILER, *counting, "-fuse-ld=gold", "-o", str(out), *parts, *libraries]
        status, text = run(command, {}, 300, room)
        if status != 0:
            raise Stillborn(text[-2000:])
        return out

    # --- judging -----------------------------------------------------------------------------------------------------
    def stage(self, program, name, pattern, environment, room):
        limit = 20 + 15 * self.seconds.get(name, 40)  # others use this machine too
        status, text = run([str(program), f"--gtest_filter={pattern}", "--gtest_fail_fast", "--gtest_brief=1"],
                           {**TESTS, **environment}, limit, room)
        if status is None:
            raise Killed(f"{name}: out of time")
        if status != 0:
            failed = [line.split()[3] for line in text.splitlines() if line.startswith("[  FAILED  ]") and len(line.split()) > 3]
            raise Killed(f"{name}: {failed[0].rstrip(',') if failed else f'status {status}'}")

    def stages(self, objects, room, names=None):
        programs = {}
        for name, kind, pattern, environment in self.used:
            if names is not None and name not in names:
                continue
            if kind not in programs:
                programs[kind] = self.link(kind, objects, room)
            begin = time.monotonic()
            self.stage(programs[kind], name, pattern, environment, room)
            if not self.original:
                self.seconds[name] = time.monotonic() - begin

    def room(self, name):
        room = self.work / name
        shutil.rmtree(room, ignore_errors=True)
        room.mkdir()
        return room

    def baseline(self, files):
        """Nothing changed: every oracle must be content."""
        room = self.room(f"baseline_{os.getpid()}")
        copies = {}
        for file in files:
            if file.endswith(".cpp"):
                source = self.place(file, (self.root / file).read_bytes(), room)
                copies[file] = self.compile(file, room, source=source)
        try:
            self.stages(list(copies.values()), room)
        except (Killed, Stillborn) as wrong:
            raise SystemExit(f"mutate: without any mutant: {wrong}") from wrong
        self.original = {file: copy.read_bytes() for file, copy in copies.items()}
        shutil.rmtree(room)

    @staticmethod
    def place(file, source, room):
        path = room / file.rsplit("/", 1)[-1]
        path.write_bytes(source)
        return path

    @staticmethod
    def needs_tests(mutant):
        """The specification judges every cell but those of the event `none`, which it does not have."""
        return mutant.operator != "cell" or mutant.function.endswith("[14]")

    def judge(self, mutant, name):
        """killed, survived, equivalent or stillborn, and by what."""
        room = self.room(name)
        try:
            changed = mutant.apply((self.root / mutant.file).read_bytes())
            if mutant.operator == "cell":
                self.judge_cell(mutant, changed, room)
            elif mutant.file.endswith(".hpp"):
                self.judge_header(mutant, changed, room)
            else:
                made = self.compile(mutant.file, room, source=self.place(mutant.file, changed, room))
                if made.read_bytes() == self.original[mutant.file]:
                    return "equivalent", "the compiler: the same object"
                self.stages([made], room)
            return "survived", ""
        except Killed as by:
            return "killed", str(by)
        except Stillborn as why:
            return "stillborn", str(why).splitlines()[0] if str(why) else ""
        finally:
            shutil.rmtree(room, ignore_errors=True)

    def shadow(self, mutant, changed, room):
        path = room / mutant.file
        path.parent.mkdir(parents=True)
        path.write_bytes(changed)
        return room / "include"

    def judge_header(self, mutant, changed, room, names=None):
        shadow = self.shadow(mutant, changed, room)
        made = [self.compile(file, room, shadow=shadow) for file in (
            "src/health/decision.cpp", "tests/health/induction_test.cpp", "tests/health/transition_table_test.cpp")]
        self.stages(made, room, names)

    def judge_cell(self, mutant, changed, room):
        shadow = self.shadow(mutant, changed, room)
        program = room / "print_table"
        command = [COMPILER, "-std=c++17", "-DPLUMB_CAPACITY=8", f"-I{shadow}", f"-I{self.root / 'include'}",
                   str(self.root / "tests/mutation/print_table.cpp"), "-o", str(program)]
        status, text = run(command, {}, 120, room)
        if status != 0:
            if "static assertion failed" in text:
                raise Killed("static_assert")
            raise Stillborn(text[-2000:])
        status, text = run([str(program)], {}, 20, room)
        if status != 0 or table.printed(text) != self.specified:
            raise Killed("specification")
        shutil.rmtree(room / "include")
        self.judge_header(mutant, changed, room, ("induction",))
