"""How the docs read: sentences of at most 40 words, a glossary of at most 40 terms, a manual for developers of at most ten pages, a window told by at most six files,
words of the field. And of the sources: no class that is another's friend, no `default:` that takes whatever a switch does not name.
Run by ctest: words_test.py. SPDX-License-Identifier: Apache-2.0"""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_WORDS = 40
# Words that only the authors of the first programs knew, and parts of identifiers made of them.
PRIVATE = re.compile(r"\b(territor(y|ies)|leant|common part|go_back|has_common|felt_\w+)\b", re.IGNORECASE)


def tracked(*patterns):
    found = subprocess.run(["git", "-C", str(ROOT), "ls-files", "--", *patterns], capture_output=True, text=True, check=True)
    return [ROOT / name for name in found.stdout.splitlines() if (ROOT / name).exists()]


def paragraphs(text):
    """(line, text) of each paragraph, item of a list and cell of a table; code and pictures left out."""
    text = re.sub(r"```.*?```", lambda code: "\n" * code.group().count("\n"), text, flags=re.S)
    found, begin, words = [], 0, []

    def close():
        if words:
            found.append((begin, " ".join(words)))
        words.clear()
    for number, line in enumerate(text.split("\n"), 1):
        line, indented = line.strip(), line.startswith("    ")
        if indented and not words or not line or line.startswith(("#", "![")):
            close()
        elif line.startswith("|"):
            close()
            found += [(number, cell) for cell in line.strip("|").split("|")]
        else:
            if re.match(r"([-*]|\d+\.)\s", line):
                close()
            if not words:
                begin = number
            words.append(line)
    close()
    return found


def sentences(paragraph):
    plain = re.sub(r"\$[^$]*\$", "F", paragraph)
    plain = re.sub(r"`[^`]*`", "C", plain).replace("<br>", ". ")
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", plain)
    plain = re.sub(r"\b(e\.g|i\.e|et al|Fig|Eq|vs|No)\.", r"\1", plain)
    return re.split(r"(?<=[.!?])\s", plain)


class Words(unittest.TestCase):
    def complain(self, found):
        self.assertFalse(found, "\n".join(["", *found]))

    def test_sentences_have_at_most_forty_words(self):
        self.assertEqual([len(sentences(text)) for _, text in paragraphs("- One `a. b`. Two\n  more.\n\n| c. d | e |\n")], [2, 2, 1])
        found = []
        for page in tracked("*.md"):
            for line, text in paragraphs(page.read_text()):
                for sentence in sentences(text):
                    count = sum(bool(re.search(r"\w", word)) for word in sentence.split())
                    if count > MOST_WORDS:
                        found.append(f"{page.relative_to(ROOT)}:{line}: {count} words: {sentence}")
        self.complain(found)

    def test_the_glossary_has_at_most_forty_terms(self):
        rows = [line for line in (ROOT / "docs/user/glossary.md").read_text().splitlines() if line.startswith("|")]
        self.assertLessEqual(len(rows) - 2, 40)

    def test_the_manual_for_developers_has_at_most_ten_pages(self):
        self.assertLessEqual(len(list((ROOT / "docs/developer").glob("*.md"))), 10)

    def test_a_window_is_told_by_at_most_six_files(self):
        named = set(re.findall(r"[\w/]+\.(?:cpp|hpp|py)\b", (ROOT / "docs/developer/window.md").read_text()))
        self.assertLessEqual(len(named), 6, named)

    def test_words_are_those_of_the_field(self):
        found = []
        for file in tracked("*.md", "*.cpp", "*.hpp", "*.py", "ci/*"):
            if file != pathlib.Path(__file__).resolve():
                found += [f"{file.relative_to(ROOT)}:{n}: {line.strip()}" for n, line in enumerate(file.read_text(errors="ignore").splitlines(), 1)
                          if PRIVATE.search(line)]
        self.complain(found)

    def test_no_class_is_a_friend_and_no_switch_takes_the_rest(self):
        found = []
        for file in tracked("src/*.cpp", "src/*.hpp", "kernels/*.cpp", "kernels/*.hpp", "runtime/*.cpp", "runtime/*.hpp"):
            found += [f"{file.relative_to(ROOT)}:{n}: {line.strip()}" for n, line in enumerate(file.read_text().splitlines(), 1)
                      if re.search(r"\bfriend (class|struct)\b|^\s*default:", line)]
        self.complain(found)


if __name__ == "__main__":
    unittest.main()
