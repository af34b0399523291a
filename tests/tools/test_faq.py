# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The errors that docs/faq.md quotes are messages of the program."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def messages():
    """All sources in one text, with string literals over several lines joined."""
    files = [file for folder in ("src", "apps") for file in sorted((ROOT / folder).rglob("*.?pp"))]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    return re.sub(r'"\s*\n\s*"', "", text).replace('\\"', '"')


def quotations(page):
    """The quotations in the bold beginnings of paragraphs."""
    bold = re.findall(r"^\*\*(.+?)\*\*", page, re.MULTILINE)
    return [quoted for heading in bold for quoted in re.findall(r'"([^"]+)"', heading)]


class Quotations(unittest.TestCase):
    def test_are_what_the_program_says(self):
        told = messages()
        quoted = quotations((ROOT / "docs/faq.md").read_text(encoding="utf-8"))
        self.assertGreater(len(quoted), 10)
        for text in quoted:
            # Numbers, and N for one, are filled in by the program.
            parts = [re.escape(part) for part in re.split(r"\bN\b|[\d.]*\d", text)]
            self.assertRegex(told, r"\{[^}]*\}".join(parts), text)

    def test_are_found_in_bold_beginnings_alone(self):
        page = '**"one", "two" of three.** Not "four".\nNor **"five"**.\n'
        self.assertEqual(quotations(page), ["one", "two"])


if __name__ == "__main__":
    unittest.main()
