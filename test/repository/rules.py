"""The rules that this repository sets itself (doc/development.md), and that each rule sees what breaks it.

Rules return what they find as "file:line: what is wrong"."""
import math
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()

# Files.


def text_files(root):
    """All text files below a folder, or the file itself. Files with a zero byte are not text."""
    files = [root] if root.is_file() else sorted(p for p in root.rglob("*") if p.is_file())
    return [p for p in files if b"\0" not in p.read_bytes()]


def text_of(file):
    return file.read_bytes().decode(errors="surrogateescape")


def lines_of(file):
    """Numbered from 1, without their ends."""
    return enumerate(text_of(file).removesuffix("\n").split("\n"), 1)


def sources(root):
    return [p for p in text_files(root) if p.suffix in (".h", ".cpp")]


def line_of(text, position):
    return text.count("\n", 0, position) + 1


# Includes.

STORE = "store"  # the folder of headers that a library has for some others, and does not install


def include_table(markdown):
    """What each library or room may include."""
    table, is_in_table = {}, False
    for _, line in lines_of(markdown):
        is_in_table = line.startswith("| library or room |") or (is_in_table and line != "")
        row = re.fullmatch(r"\| `([a-z_/]+)` \| ([\w., /-]+) \|", line)
        if is_in_table and row:
            table[row[1]] = set() if row[2] == "nothing" else set(re.findall(r"[\w./-]+", row[2]))
    return table


def room_of(file):
    """"library", or "library/room" for a file in a folder of include/library/ or of src/. What is in store/ is of the
    library itself."""
    folders = file.parts[:-1]
    if STORE in folders[1:2]:
        return folders[0]
    above = 3 if folders[1:2] == ("include",) else 2
    return "/".join((folders[0],) + folders[above:above + 1])


def names_of(path):
    """What the table calls the includes of a path: "mrpt", and the first two parts, "library/room". Who may include a
    library may not yet include what is in its store/."""
    parts = path.split("/")
    names = [] if len(parts) > 2 and parts[1] == STORE else parts[:1]
    return names + (["/".join(parts[:2])] if len(parts) > 2 else [])


def objection(quoted, path, file, room, allowed):
    """Why an include does not belong into a file, or None."""
    if path == "iostream":
        return "prints: <iostream> belongs to applications"
    near = quoted and not path.startswith("..")
    if near and (file.parent / path).exists():
        return None
    full = room.split("/")[0] + "/" + path if near else path
    is_standard = "." not in path and "/" not in path
    if is_standard or any(n in allowed or n in (room, f"{room}/{STORE}") for n in names_of(full)):
        return None
    return f"{room} may not include {path}"


def forbidden_includes(libs, table):
    findings = []
    for file in sources(libs):
        room = room_of(file.relative_to(libs))
        for number, line in lines_of(file):
            include = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
            if not include:
                continue
            problem = f"{room} has no row in the table of includes"
            if room in table:
                problem = objection(include[1] == '"', include[2], file, room, table[room])
            if problem:
                findings.append(f"{file.relative_to(libs)}:{number}: {problem}")
    return findings


ALGORITHM = re.compile(
    r"std::((stable_|partial_)?sort|nth_element|find(_if(_not)?)?|(all|any|none)_of|count(_if)?|copy(_if|_n)?|fill(_n)?"
    r"|shuffle|reverse|rotate|unique|remove_if|(lower|upper)_bound|equal(_range)?|binary_search"
    r"|(min|max|minmax)_element|minmax|clamp|adjacent_find|search|includes|set_(union|difference|intersection)"
    r"|next_permutation|(push|pop|make)_heap)\(")


def algorithms_without_their_header(root):
    findings = []
    for file in sources(root):
        text = text_of(file)
        call = ALGORITHM.search(text)
        if call and "\n#include <algorithm>\n" not in "\n" + text[:call.start()]:
            findings.append(f"{file.relative_to(root)}:{line_of(text, call.start())}: std::{call[1]} needs <algorithm>")
    return findings


# Lines.

SPACE = (r"[ \t\r]$", "space at the end of the line")
RETURN = (r"\r", "a carriage return")
MACHINE = (r"(^|[^\w.}])/(work|home|root|tmp|Users|mnt)/|(deb|ftp|security|archive)\.(debian|ubuntu)\.",
           "a path or a server of one machine")
BORROWED = (r'^\s*(#\s*include\s*")?(\.\./)+(apps|[\w-]+-[\w-]+)/[^ ]*\.(h|cpp)"?$', "a source of another program")


def lines_that_match(rule, root):
    base = root.parent if root.is_file() else root
    return [f"{file.relative_to(base)}:{number}: {rule[1]}"
            for file in text_files(root) for number, line in lines_of(file) if re.search(rule[0], line)]


def option_names_with_spaces(root):
    """Newer releases of CLI11 abort at them."""
    pattern = r'add_(option|flag)(_function|_callback)?(<[^(]*>)?\(\s*"[^"]*\s[^"]*"'
    return [f"{file.relative_to(root)}:{line_of(text_of(file), call.start())}: a name with spaces"
            for file in sources(root) for call in re.finditer(pattern, text_of(file))]


def files_longer_than(most, root):
    counts = [(file, len(list(lines_of(file)))) for file in sources(root)]
    return [f"{file.relative_to(root)}:{n}: more than {most} lines" for file, n in counts if n > most]


# Documents.


def broken_links(markdown):
    return [f"{markdown.name}:{number}: no file {link}" for number, line in lines_of(markdown)
            for link in re.findall(r"\]\(([^):#]+)[^):]*\)", line) if not (markdown.parent / link).exists()]


def excerpts_that_differ(markdown):
    """Blocks of C++ or Python below a line that links to a source, which that source does not have: line by line,
    however they are indented."""
    def flat(text):
        return re.sub(r"\s*\n\s*", "\n", text)

    findings, source, excerpt = [], None, None
    for number, line in lines_of(markdown):
        if line.startswith("```"):
            if excerpt and flat(excerpt[2]) not in flat("\n" + text_of(markdown.parent / excerpt[1])):
                findings.append(f"{markdown.name}:{excerpt[0]}: {excerpt[1]} does not have these lines")
            excerpt = [number, source, "\n"] if source and line in ("```cpp", "```python") else None
            source = None
        elif excerpt:
            excerpt[2] += line + "\n"
        elif line:
            link = re.search(r"\]\(([^)]*\.(?:cpp|py))\)", line)
            source = link[1] if link else None
    return findings


def literals_of(source):
    """The texts in a source; those that are only parted by the end of a line are one."""
    joined = re.sub(r'"\s*\n\s*"', "", text_of(source))
    return [t.replace('\\"', '"') for t in re.findall(r'"((?:[^"\\\n]|\\.)*)"', joined)]


def is_said(part, literals):
    """By one text, or by two that a source puts together."""
    return any(part in text for text in literals) or any(
        any(text.endswith(part[:split]) for text in literals) and
        any(text.startswith(part[split:]) for text in literals) for split in range(3, len(part) - 2))


def messages_nobody_says(markdown, folders):
    """Of those in `backticks` in the first column of tables. What changes in them is FILE, NAME, X (a capital alone), a
    number, or `...`."""
    literals = [text for folder in folders for source in sources(folder) for text in literals_of(source)]
    findings = []
    for number, line in lines_of(markdown):
        column = line.split(" | ")[0] if line.startswith("| ") else ""
        for message in re.findall("`([^`]*)`", column):
            for part in re.split(r"FILE|NAME|\.\.\.|\b[A-Z]\b|[0-9]+|'", message):
                part = part.strip(" :;,()[]=")
                if len(part) > 2 and not is_said(part, literals):
                    findings.append(f"{markdown.name}:{number}: {part}")
    return findings


# Prose.


def count_words(text):
    """What stands between spaces and has a letter or a digit."""
    return sum(any(c.isascii() and c.isalnum() for c in word) for word in text.split())


def paragraphs(markdown):
    """Paragraphs, list items and cells of tables, without headings and code."""
    found, current, is_fenced = [], "", False
    for line in markdown.split("\n"):
        fence, table = line.startswith("```"), line.startswith("|")
        code = current == "" and line.startswith("    ")
        is_fenced ^= fence
        item = re.match(r"\s*([-*]|\d+\.) ", line)
        breaks = is_fenced or fence or code or table or line == "" or line[0] == "#"
        if breaks or item:
            found, current = found + [current], ""
        if not breaks:
            current += line[item.end() if item else 0:] + " "
        elif table and not is_fenced:
            found += line.split("|")
    return found + [current]


def sentences_of(markdown):
    """Those of four words or more. A link is its text, and code within a sentence is one word."""
    sentences = []
    for text in paragraphs(markdown):
        text = re.sub("`[^`]*`", "Code", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text))
        sentences += re.split(r'[.?!]["*)]*\s+(?=["(*A-Z0-9])', text)
    return [s for s in sentences if count_words(s) >= 4]


def quantile(numbers, share):
    """The smallest of the numbers that a share of them does not exceed."""
    return sorted(numbers)[max(1, math.ceil(share * len(numbers))) - 1]


def pages():
    """The README and the pages of doc/, without studies, which are frozen, and the page of options, which a program
    writes."""
    return [ROOT / "README.md"] + [
        p for p in text_files(ROOT / "doc")
        if p.suffix == ".md" and p.name != "options.md" and p.parent.name != "studies"]


class Rule(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scratch = Path(folder.name)

    def write(self, name, text):
        file = self.scratch / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text.encode())
        return file

    def folders(self, *names):
        return [ROOT / name for name in names]


class Includes(Rule):
    def test_libraries_include_only_what_their_row_allows(self):
        self.assertEqual(forbidden_includes(ROOT / "libs", include_table(ROOT / "doc/development.md")), [])

    def found(self, files, table):
        for name, text in files.items():
            self.write(name, text)
        return forbidden_includes(self.scratch, table)

    def test_what_is_forbidden_is_found(self):
        cases = [
            # across a boundary
            ({"pure/include/pure/Good.h": "#include <Eigen/Core>\n#include <pure/Other.h>\n",
              "pure/src/Bad.cpp": "#include <vector>\n  #  include <mrpt/poses/CPose3D.h>\n"}, {"pure": {"Eigen"}},
             ["pure/src/Bad.cpp:2: pure may not include mrpt/poses/CPose3D.h"]),
            # in quotes, not beside it
            ({"a/src/Near.h": "", "b/src/Far.h": "",
              "a/src/Bad.cpp": '#include "Near.h"\n#include "../../b/src/Far.h"\n'}, {"pure": {}, "a": {}, "b": {}},
             ["a/src/Bad.cpp:2: a may not include ../../b/src/Far.h"]),
            # back up between rooms
            ({"house/src/cellar/Bad.cpp":
              '#include <house/attic/Roof.h>\n#include "attic/Beams.h"\n#include "Near.h"\n',
              "house/src/cellar/Near.h": "#include <house/cellar/Stone.h>\n",
              "house/src/attic/Good.cpp": '#include <house/cellar/Stone.h>\n#include "cellar/Near.h"\n'},
             {"house/cellar": set(), "house/attic": {"house/cellar"}},
             ["house/src/cellar/Bad.cpp:1: house/cellar may not include house/attic/Roof.h",
              "house/src/cellar/Bad.cpp:2: house/cellar may not include attic/Beams.h"]),
            # of a store that is for others
            ({"house/store/house/store/Beams.h": "#include <house/store/Nails.h>\n",
              "guest/src/Bad.cpp": "#include <house/Door.h>\n#include <house/store/Beams.h>\n"},
             {"house": set(), "guest": {"house"}},
             ["guest/src/Bad.cpp:2: guest may not include house/store/Beams.h"]),
            ({"pure/src/Bad.cpp": "#include <iostream>\n"}, {"pure": set()},
             ["pure/src/Bad.cpp:1: prints: <iostream> belongs to applications"]),
            ({"fresh/src/File.cpp": "#include <vector>\n"}, {},
             ["fresh/src/File.cpp:1: fresh has no row in the table of includes"])]
        for files, table, findings in cases:
            self.setUp()
            self.assertEqual(self.found(files, table), findings)

    def test_whoever_sorts_or_finds_includes_algorithm(self):
        for folder in self.folders("libs", "apps", "test", "doc"):
            self.assertEqual(algorithms_without_their_header(folder), [])
        self.write("Good.cpp", "#include <algorithm>\nvoid f(V& v) { std::sort(v.begin(), v.end()); }\n")
        self.write("Bad.cpp", "#include <vector>\nint n = text.find(x);\nauto i = std::find_if(a, b, c);\n")
        self.assertEqual(algorithms_without_their_header(self.scratch), ["Bad.cpp:3: std::find_if needs <algorithm>"])


class Lines(Rule):
    def test_have_no_space_at_their_end_no_carriage_return_and_no_path_of_a_machine(self):
        parts = ".ci .github .pre-commit-config.yaml apps cmake config doc libs rawlog-samples scripts test README.md " \
            "CHANGELOG.md CITATION.cff CONTRIBUTING.md CMakeLists.txt CMakePresets.json Doxyfile debian-packages.txt " \
            "package.xml run-demo run-tests"
        for part in filter(Path.exists, self.folders(*parts.split())):
            for rule in (SPACE, RETURN, MACHINE):
                self.assertEqual(lines_that_match(rule, part), [])
            for file in text_files(part):
                self.assertEqual(broken_links(file) if file.suffix == ".md" else [], [])

    def test_that_have_are_found(self):
        for rule, text, numbers in [(SPACE, "good\nbad \nbad\t\n", [2, 3]), (RETURN, "good\nb\rad\nbad\r\n", [2, 3]),
                                    (MACHINE, "cd /" "home/me\nhttps://deb." "debian.org\na/tmp/b /usr/share\n", [1, 2]),
                                    (BORROWED, '  ../map-tool/Report.cpp\n#include "../x/Town.h"\n'
                                     '#include "../../apps/map-tool/Report.h"\n', [1, 3])]:
            file = self.write("some.txt", text)
            self.assertEqual(lines_that_match(rule, file), [f"some.txt:{n}: {rule[1]}" for n in numbers])
        self.write("there.md", "")
        file = self.write("file.md", "[a](there.md) [b](there.md#part)\n[c](https://x.org/y) ![d](gone.png)\n")
        self.assertEqual(broken_links(file), ["file.md:2: no file gone.png"])

    def test_of_programs_and_tests_take_no_source_of_another_program(self):
        for folder in self.folders("apps", "test"):
            self.assertEqual(lines_that_match(BORROWED, folder), [])

    def test_with_names_of_options_have_no_spaces_in_these(self):
        for folder in self.folders("apps", "test/benchmark"):
            self.assertEqual(option_names_with_spaces(folder), [])
        self.write("main.cpp", 'app.add_option("FILE", file, "A file to read");\n'
                   'app.add_option_function<std::string>(\n    "FILE... OUT", take);\n')
        self.assertEqual(option_names_with_spaces(self.scratch), ["main.cpp:2: a name with spaces"])

    def test_that_are_too_many_in_a_file_are_named(self):
        for folder in self.folders("libs", "apps", "test"):
            for finding in files_longer_than(400, folder):
                print(f"warning: {folder.name}/{finding}")
        self.assertEqual(files_longer_than(39, ROOT / "doc/examples"), [])
        self.write("Long.cpp", "1\n2\n3\n")
        self.write("Short.h", "1\n2\n")
        self.assertEqual(files_longer_than(2, self.scratch), ["Long.cpp:3: more than 2 lines"])


class Documents(Rule):
    def test_show_the_examples_as_they_are(self):
        for page in text_files(ROOT / "README.md") + text_files(ROOT / "doc"):
            self.assertEqual(excerpts_that_differ(page), [])
        self.write("main.cpp", "int main() {\n  load();\n  save();\n}\n")
        file = self.write("file.md", "From [it](main.cpp):\n\n```cpp\nload();\nsave();\n```\nOf nothing:\n```cpp\nx();\n```\n"
                          "Again [it](main.cpp):\n```cpp\nload();\n\nclose();\n```\n")
        self.assertEqual(excerpts_that_differ(file), ["file.md:12: main.cpp does not have these lines"])

    def test_describe_each_library_with_its_own_sentence_and_have_its_headers(self):
        sentences = dict(re.findall(r"^\| \[`(\w+)`\]\(../libs/\w+\) \| (.*) \|$", text_of(ROOT / "doc/README.md"), re.M))
        for library in filter(Path.is_dir, (ROOT / "libs").iterdir()):
            comment = re.match("(# .*\n)+", text_of(library / "CMakeLists.txt"))[0].replace("\n# ", " ")
            self.assertGreater(len(sentences.get(library.name, "")), 10, library)
            self.assertTrue(comment.startswith("# " + sentences[library.name]), library)
            if (library / "include").exists():
                self.assertIn(f"libs/{library.name}/include", text_of(ROOT / "Doxyfile"))

    def test_have_each_a_name_of_its_own(self):
        names = [p.name for p in text_files(ROOT / "doc") if p.name not in ("README.md", "CMakeLists.txt")]
        self.assertEqual(len(names), len(set(names)))

    def test_are_there_for_each_program(self):
        for folder in self.folders("apps", "test/benchmark"):
            for listed in folder.glob("*/CMakeLists.txt"):
                self.assertTrue((listed.parent / "README.md").exists(), listed)

    def test_have_the_version_of_the_project_and_each_package_once(self):
        version = text_of(ROOT / "VERSION").split("\n")[0]
        self.assertIn(f"<version>{version}</version>\n", text_of(ROOT / "package.xml"))
        self.assertIn(f"\nversion: {version}\n", text_of(ROOT / "CITATION.cff"))
        packages = [line.split(" ")[0] for _, line in lines_of(ROOT / "debian-packages.txt") if line and line[0] not in "#["]
        self.assertEqual(len(packages), len(set(packages)))

    def test_explain_messages_that_are_said(self):
        self.assertEqual(messages_nobody_says(ROOT / "doc/handbook/troubleshooting.md", self.folders("libs", "apps")), [])
        self.write("main.cpp", 'fail(file + ": has " + count + " bytes too "\n     "many"); fail("unknown " + kind);\n'
                   'kind = "section";\n')
        file = self.write("file.md", "| message | what |\n|---|---|\n| `FILE: has 3 bytes too many` | `other` |\n"
                          "| `unknown section` | |\n| `FILE: has no bytes`, `unknown key X` | |\n")
        self.assertEqual(messages_nobody_says(file, [self.scratch]), ["file.md:5: has no bytes", "file.md:5: unknown key"])


class Prose(Rule):
    def test_of_all_pages_has_at_most_thirty_thousand_words(self):
        words = sum(count_words(text_of(page)) for page in pages())
        print(f"{words} words")
        self.assertTrue(10_000 < words <= 30_000)

    def test_has_sentences_of_which_nine_in_ten_have_at_most_25_words(self):
        lengths = [count_words(sentence) for page in pages() for sentence in sentences_of(text_of(page))]
        self.assertLessEqual(quantile(lengths, 0.9), 25)

    def test_of_long_pages_is_named(self):
        for folder, most in [("doc/how-it-works", 1200), ("doc/handbook", 800), ("apps", 400)]:
            for page in (ROOT / folder).rglob("*.md"):
                words = count_words(text_of(page))
                if page.name != "options.md" and words > most:
                    print(f"warning: {page.relative_to(ROOT)} has {words} words, more than {most}")

    def test_is_counted_without_headings_and_code(self):
        self.assertEqual(sentences_of(
            "# A heading of five words\n\nOne two [three four](five.md) `a b`\nsix. And a second *sentence* here!\n\n"
            "    code of four words\n\n```sh\nmore code of words\n```\n- an item of words\n- only three words\n\n"
            "| a cell of words | no |\n|---|---|\n"),
            ["One two three four Code six", "And a second *sentence* here! ", "an item of words ", " a cell of words "])
        self.assertEqual(count_words("one - two2 | (three) --"), 3)
        self.assertEqual(quantile([30, 1, 2, 3, 4, 5, 6, 7, 8, 9], 0.9), 9)
        self.assertEqual(quantile([30, 31, 2, 3, 4, 5, 6, 7, 8, 9], 0.9), 30)


if __name__ == "__main__":
    unittest.main()
