#!/usr/bin/env python3
"""Writes a ctest file with an entry for each test case of a Catch2 executable: discover_tests.py PROGRAM OUT MPIRUN ENVIRONMENT [RANKS...].

An entry is called FILE: CASE (the source file's name without _test.cpp), so that `ctest -R osher` finds both. A case tagged [nightly]
or [long] has that label instead of `fast`; the executable's name is another. One tagged [mpiN] runs by mpirun on N ranks. A rank count
without a case is an error, so that no entry runs nothing. Run by the build after each link (tests/CMakeLists.txt).
"""
import pathlib
import re
import subprocess
import sys

TIMEOUT_S = {"fast": 600, "nightly": 3600, "long": 36000}
RANK_TAGS = (2, 3, 4, 8, 64)


def cases(program, spec):
    """(file stem, case) of each case that the tags select, in the order of the sources."""
    listed = subprocess.run([program, spec, "--list-test-names-only", "-v", "high"], capture_output=True, text=True).stdout
    for line in listed.splitlines():
        name, _, place = line.partition("\t@")
        if place:
            stem = pathlib.Path(re.split(r"[:(]\d+\)?$", place)[0]).stem
            yield re.sub("_test$", "", stem), name.strip('"')


def quoted(text):
    return f"[==[{text}]==]"


def entry(command, stem, name, ranks, label, properties):
    only = re.sub(r"([,\[\]\\])", r"\\\1", name)
    title = quoted(f"{stem}: {name}" + (f" ({ranks} ranks)" if ranks > 1 else ""))
    labels = quoted(f"{label};{pathlib.Path(command[-1]).name}")
    return (f"add_test({title} {' '.join(map(quoted, command))} {quoted(only)})\n"
            f"set_tests_properties({title} PROPERTIES LABELS {labels} TIMEOUT {TIMEOUT_S[label]} {properties})\n")


def main():
    program, out, mpirun, environment, *ranks = sys.argv[1:]
    text = ""
    alone = "".join(f"~[mpi{n}]" for n in RANK_TAGS)
    for count in [1, *map(int, ranks)]:
        command = [program] if count == 1 else [mpirun, str(count), program]
        where = alone if count == 1 else f"[mpi{count}]"
        properties = f"ENVIRONMENT {quoted(environment)}" if environment else ""
        if count > 1:
            properties += " PROCESSORS 2"
        found = 0
        for label, tags in (("fast", "~[nightly]~[long]"), ("nightly", "[nightly]~[long]"), ("long", "[long]")):
            for stem, name in cases(program, tags + where):
                text += entry(command, stem, name, count, label, properties)
                found += 1
        if not found and (count > 1 or not ranks):
            sys.exit(f"{program}: no test case for {count} rank(s)")
    pathlib.Path(out).write_text(text)


main()
