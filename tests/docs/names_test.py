"""Every path, file and identifier that the docs name exists: links, files in backticks, keys of scenes, functions and types of the sources.
Run by ctest: names_test.py [ROOT]. SPDX-License-Identifier: Apache-2.0"""
import fnmatch
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What a run, a build or a cluster makes, and names that stand for others.
MADE = re.compile(r"^(/|~|runs/|run\d*/|build/|fields/|checkpoints/|perf/results/|spread/|OUT|DIR|RUN|NAME)|[A-Z]{3,}|[<>{}$*…]|\.\.\.|~")
SUFFIXES = {"md", "cpp", "hpp", "py", "toml", "csv", "png", "css", "html", "txt", "nmf", "p3d", "json", "sh", "webm", "mp4", "def"}
# Files of runs, of users and of other programs, named without a folder.
OUTSIDE = {"scene.toml", "history.csv", "summary.json", "log.txt", "trace.json.gz", "report.html", "comparison.html", "study.html", "study.json", "load_cases.csv", "spanwise.csv", "rotor.p3d", "rotor.nmf", "rotor.cgns",
           "picture.png", "film.mp4", "film.webm", "paraview.py", "geometry.xdmf", "wake.xdmf", "latest.json", "settings.json", "perf.json", "compile_commands.json", "exit.txt"}
# Words in backticks that look like identifiers of ours and belong to a language, a library or a system.
FOREIGN = re.compile(r"^(_|std|MPI|hypre|h5py|numpy|np|OMP|omp|HYPRE|H5|METIS|Eigen|toml|spdlog|fmt|CLI|TBB|tbb|vtk|pv|gcc|clang|git|apt|cmake|ctest|mpirun)\b")

# Names that the program puts together, and symbols of equations.
PUT_TOGETHER = {"heave_x_m", "heave_y_m", "heave_z_m", "p_ref"}
# Keys of other programs' files.
OTHERS_KEYS = {"control.torque.tsr"}
# Files of other projects.
ELSEWHERE = {"tests/quasi_static_chain.cpp"}
# What the program is built with: {find_package's name: (Debian's package, Spack's, word of the install guide)}.
NEEDED = {"MPI": ("libopenmpi-dev", "mpi", "MPI"), "HDF5": ("libhdf5-openmpi-dev", "hdf5", "HDF5"), "Eigen3": ("libeigen3-dev", "eigen", "Eigen"),
          "METIS": ("libmetis-dev", "metis", "METIS"), "ZLIB": ("zlib1g-dev", "zlib-api", "zlib"), "HYPRE": ("libhypre-dev", "hypre", "hypre"), "CGNS": ("libcgns-dev", "cgns", "CGNS"),
          "fmt": ("libfmt-dev", "fmt", "fmt"), "spdlog": ("libspdlog-dev", "spdlog", "spdlog"), "nlohmann_json": ("nlohmann-json3-dev", "nlohmann-json", "nlohmann-json"),
          "tomlplusplus": ("libtomlplusplus-dev", "tomlplusplus", "toml++"), "CLI11": ("libcli11-dev", "cli11", "CLI11"), "yaml-cpp": ("libyaml-cpp-dev", "yaml-cpp", "yaml-cpp")}
OF_THE_COMPILER = {"OpenMP", "Threads"}
OF_THE_TESTS = {"Catch2"}


def tracked(*patterns):
    found = subprocess.run(["git", "-C", str(ROOT), "ls-files", "--", *patterns], capture_output=True, text=True, check=True)
    return [name for name in found.stdout.splitlines() if (ROOT / name).exists()]


class Names(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = tracked()
        cls.base_names = {name.rpartition("/")[2] for name in cls.files}
        cls.pages = [name for name in cls.files if name.endswith(".md")]
        cls.source = "\n".join((ROOT / n).read_text(encoding="utf-8", errors="ignore") for n in cls.files
                               if n.endswith((".cpp", ".hpp", ".py", ".txt", ".cmake", ".toml", ".sh", ".json")) or n.startswith("ci/") or n.endswith("/run"))
        cls.words = set(re.findall(r"[A-Za-z_][A-Za-z0-9_]*", cls.source))
        cls.words |= {word for name in cls.files for part in name.split("/") for word in (part, part.partition(".")[0])}
        cls.keys = set(re.findall(r"^\| `([a-z_0-9A-Z]+)` \|", (ROOT / "inputs/REFERENCE.md").read_text(), re.M))
        cls.sections = set(re.findall(r"^## `\[+([^\]]+)\]+`", (ROOT / "inputs/REFERENCE.md").read_text(), re.M))

    def complain(self, found):
        self.assertFalse(found, f"{len(found)} dead:\n" + "\n".join(found))

    def exists(self, name, beside=ROOT):
        """A path from the root, from the page, from docs/, or a file's own name; a pattern where it matches something."""
        name = re.sub(r"\.hpp/\.cpp$", ".hpp", name.rstrip("/").split("#")[0].split("::")[0])
        if "*" in name:
            return any(fnmatch.fnmatch(file, "*/" + name) or fnmatch.fnmatch(file, name) for file in self.files)
        if any((base / name).exists() for base in (ROOT, beside)):
            return True
        return any(file.endswith("/" + name) or file.startswith(name + ".") for file in self.files)

    def test_links(self):
        dead = []
        for page in self.pages:
            text = re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = (ROOT / page).parent / path if path else ROOT / page
                if not file.exists():
                    dead.append(f"{page}: {target}")
                elif anchor and file.suffix == ".md":
                    headings = re.findall(r"^#+ (.*)$", file.read_text(encoding="utf-8"), re.M)
                    slugs = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}
                    if anchor not in slugs:
                        dead.append(f"{page}: {target}: no such heading")
        self.complain(dead)

    def test_the_index_leads_to_every_page(self):
        seen, ahead = set(), [ROOT / "docs/index.md"]
        while ahead:
            page = ahead.pop()
            if page in seen:
                continue
            seen.add(page)
            links = [(page.parent / target).resolve() for target in re.findall(r"\]\(([^)\s#]+)", page.read_text(encoding="utf-8")) if ":" not in target]
            ahead += [file for file in links if file.suffix == ".md" and file.exists()]
        lost = [page for page in self.pages if page.startswith(("docs/", "inputs/")) and (ROOT / page).resolve() not in seen]
        self.complain([f"{page}: no link from docs/index.md leads there" for page in lost])

    def test_paths_in_backticks(self):
        dead = []
        for page in self.pages:
            text = re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
            for word in re.findall(r"`([^`\n]+)`", text):
                word = word.split(" ")[0].rstrip(",:;")
                ending = word.rpartition(".")[2]
                is_file = ending in SUFFIXES and re.fullmatch(r"[\w./*+\-]+", word)
                is_folder = re.fullmatch(r"(src|kernels|runtime|tests|docs|inputs|perf|ci)/[\w./*+\-]*", word)
                if (is_file or is_folder) and not MADE.search(word.replace("*", "")) and word not in OUTSIDE and not word.startswith("_") and not self.exists(word, (ROOT / page).parent):
                    dead.append(f"{page}: {word}")
        self.complain(dead)

    def test_paths_in_comments_of_sources(self):
        dead = []
        for name in self.files:
            if not name.endswith((".cpp", ".hpp", ".py", ".toml")) or name.startswith("tests/docs"):
                continue
            for number, line in enumerate((ROOT / name).read_text(encoding="utf-8", errors="ignore").splitlines(), 1):
                comment = re.search(r"(//|#)\s(.*)", line)
                for word in re.findall(r"\b(?:docs|tests|src|kernels|runtime|inputs|perf|ci)/[\w./\-]*[\w/]", comment[2] if comment else ""):
                    if not MADE.search(word) and word not in ELSEWHERE and not self.exists(word.rstrip("."), (ROOT / name).parent) and not any(f.startswith(word) for f in self.files):
                        dead.append(f"{name}:{number}: {word}")
        self.complain(dead)

    def test_identifiers(self):
        """`function()`, `Type`, `snake_case` and `section.key` in the pages of developers and users are words of the sources."""
        dead = []
        for page in self.pages:
            if not page.startswith("docs/") and not page.endswith("README.md"):
                continue
            text = re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
            for word in re.findall(r"`([A-Za-z_][\w.:]*(?:\(\))?)`", text):
                bare = word.removesuffix("()")
                if bare.startswith(("_", "perf_")) or FOREIGN.match(bare) or MADE.search(bare) or bare.rpartition(".")[2] in SUFFIXES or len(bare) < 4:
                    continue
                parts = [p for p in re.split(r"[.:]+", bare) if p]
                if not ("_" in bare or "." in bare or "::" in bare or word.endswith("()") or re.match(r"[A-Z][a-z]+[A-Z]", bare)):
                    continue
                if not all(p in self.words or p in PUT_TOGETHER for p in parts):
                    dead.append(f"{page}: {word}")
        self.complain(dead)

    def test_dotted_keys_are_keys_of_their_section_or_columns(self):
        """`rotor.blade_pitch_deg`: each word of it being one of the sources is not enough."""
        reference, keys, section = (ROOT / "inputs/REFERENCE.md").read_text(encoding="utf-8"), set(), ""
        for line in reference.splitlines():
            if found := re.match(r"## `\[+([^\]]+)\]+`", line):
                section = found[1]
                keys.add(section)
            elif found := re.match(r"\| `([a-z_0-9A-Z]+)` \|", line):
                keys.add(f"{section}.{found[1]}")
        columns = set(re.findall(r"^\| `([\w.]+)` \|", (ROOT / "docs/reference/columns.md").read_text(encoding="utf-8"), re.M))
        named = {key.split(".")[0] for key in keys if "NAME" in key} | {"turbine", "controller", "study", "reference", "replicas", "load_cases"}
        first, dead = {key.split(".")[0] for key in keys} - named, []
        numbered = {re.sub(r"_[A-Z]\b", "_1", column) for column in columns}
        for page in self.pages:
            if not page.startswith(("docs/user", "docs/tutorials", "README.md", "inputs/")) or page == "inputs/REFERENCE.md":
                continue
            text = re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
            for word in re.findall(r"`([a-z_]+(?:\.\w+)+)(?: = [^`]*)?`", text):
                if word.split(".")[0] in first and word.rpartition(".")[2] not in SUFFIXES and word not in keys | columns | numbered | OTHERS_KEYS:
                    dead.append(f"{page}: {word}")
        self.complain(dead)

    def test_keys_in_blocks_of_scenes(self):
        """Keys in ```toml blocks are keys of the reference."""
        dead = []
        for page in self.pages:
            for block in re.findall(r"```toml\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), flags=re.S):
                for key in re.findall(r"^\s*([a-z_0-9A-Z]+)\s*=", block, re.M):
                    if key not in self.keys and key not in ("base", "without"):
                        dead.append(f"{page}: {key}")
        self.complain(dead)

    def test_packaging_names_what_is_built_with(self):
        """Whatever CMake looks for is in Debian's list, in the Spack recipe and in the guide."""
        text = "\n".join((ROOT / n).read_text(encoding="utf-8") for n in tracked("CMakeLists.txt", "*/CMakeLists.txt") if not n.startswith(("perf/", "tests/")))
        found = set(re.findall(r"find_package\(([\w-]+)", text)) - OF_THE_COMPILER - OF_THE_TESTS
        self.assertEqual(found, set(NEEDED))
        setup, recipe, guide = ((ROOT / n).read_text(encoding="utf-8") for n in ("ci/setup", "ci/packaging/spack/packages/spindrift/package.py", "docs/user/install.md"))
        for debian, spack, word in NEEDED.values():
            self.assertRegex(setup, rf"[( ]{re.escape(debian)}[) \n]")
            self.assertRegex(recipe, rf'depends_on\("{re.escape(spack)}[@ "]')
            self.assertIn(word, guide)
        for option in re.findall(r'"(SPINDRIFT_\w+)"', recipe) + re.findall(r"-D(SPINDRIFT_\w+)", (ROOT / "ci/packaging/Containerfile").read_text(encoding="utf-8")):
            if option != "SPINDRIFT_PYTHON":
                self.assertIn(option, text)


if __name__ == "__main__":
    unittest.main()
