# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""tools/doc_commands.py finds the commands of a page, and those that the tests would miss."""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import doc_commands  # noqa: E402  pylint: disable=wrong-import-position

REFERENCE = """# Commands

## reckon run

| option | meaning |
|---|---|
| `scene` | Scene file |
| `-o, --out TEXT` | Folder |

## reckon grains

## reckon grains info

| `--json` | Answer in JSON |
"""
KNOWN = doc_commands.known_options(REFERENCE)


def complaints(text):
    return [f"{line}: {complaint}" for line, complaint in doc_commands.complaints_of(text, KNOWN)]


class Pages(unittest.TestCase):
    def test_have_blocks_replacements_and_hidden_commands(self):
        page = doc_commands.parse("""
<!-- small: count = 9 -> count = 2 -->
<!-- small: steps 100, shapes 4 -->
<!-- first:
mkdir a
-->
```sh
reckon run a.toml
```
<!-- not run: goes on
until Ctrl-C -->

```sh
reckon run b.toml
```
""")
        self.assertEqual(page.replacements, [("count = 9", "count = 2")])
        self.assertEqual(page.limits, {"steps": 100, "shapes": 4})
        self.assertEqual([(block.kind, block.text, block.skipped) for block in page.blocks], [
            ("first", "mkdir a\n", ""), ("sh", "reckon run a.toml\n", ""),
            ("sh", "reckon run b.toml\n", "goes on until Ctrl-C")])
        self.assertEqual(page.complaints, [])

    def test_may_not_hide_commands_outside_of_blocks_that_run(self):
        self.assertEqual(complaints("Then\n\n    tools/do.sh now\n"),
                         ["3: a command outside of a block ```sh: tools/do.sh now"])
        self.assertEqual(complaints("```\nreckon run a.toml\n```\n"),
                         ["1: a command outside of a block ```sh: reckon run a.toml"])
        self.assertEqual(complaints("```text\nA=1 cmake ..\n```\n"),
                         ["1: a command outside of a block ```sh: A=1 cmake .."])
        self.assertEqual(complaints("    F = m a\n\n```\ngrains     120 found\n```\n"), [])

    def test_say_why_a_block_is_not_run(self):
        self.assertEqual(complaints("<!-- not run: -->\n```sh\nls\n```\n"), ["1: \"not run\" needs a reason"])
        stray = "1: \"not run\" does not stand before a block"
        self.assertEqual(complaints("<!-- not run: takes an hour -->\nText.\n```sh\nls\n```\n"), [stray])
        self.assertEqual(complaints("<!-- not run: takes an hour -->\nText.\n"), [stray])

    def test_name_commands_and_options_that_exist(self):
        self.assertEqual(complaints("Try `reckon rnu a.toml`.\n"), ["1: there is no command `reckon rnu`"])
        self.assertEqual(complaints("```sh\nreckon run a.toml --ou b   # --fine\n```\n"),
                         ["1: `reckon run` has no option --ou"])
        self.assertEqual(complaints("```sh\nbuild/reckon run a.toml --ou=b | grep --x\n```\n"),
                         ["1: `reckon run` has no option --ou"])
        self.assertEqual(complaints("`reckon grains ... --json`, `reckon grains info a.h5 --json`\n"), [])

    def test_of_the_project_have_no_fault(self):
        known = doc_commands.known_options((ROOT / doc_commands.MADE).read_text(encoding="utf-8"))
        for name in doc_commands.tracked_pages():
            text = (ROOT / name).read_text(encoding="utf-8")
            self.assertEqual(list(doc_commands.complaints_of(text, known, name == doc_commands.MADE)), [], name)
        self.assertGreater(len(list(doc_commands.pages_to_run())), 15)


if __name__ == "__main__":
    unittest.main()
