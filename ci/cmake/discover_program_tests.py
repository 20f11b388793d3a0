#!/usr/bin/env python3
"""Prints FILE:CLASS.METHOD of each test of Python files, as a CMake list: discover_program_tests.py FILE...

The files are imported, so that tests which they make of tables are found too. Called by tests/CMakeLists.txt.
"""
import importlib.util
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True


def tests(suite):
    for item in suite:
        yield from tests(item) if isinstance(item, unittest.TestSuite) else [item]


found = []
for file in map(pathlib.Path, sys.argv[1:]):
    sys.argv, sys.path[0] = [str(file), "spindrift"], str(file.parent)   # the program under test is not run
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    names = [f"{file.name}:{type(test).__name__}.{test._testMethodName}" for test in tests(unittest.defaultTestLoader.loadTestsFromModule(module))]
    if not names:
        sys.exit(f"{file}: no test")
    found += names
print(";".join(found), end="")
